#include "sim/view/body/transfer_function_file.h"

#include <algorithm>
#include <string>

#include "sim/files/files.h"
#include "sim/files/toml_table.h"
#include "sim/files/toml_value.h"

namespace insonate::view {
namespace fs = std::filesystem;

namespace {
constexpr std::size_t kLargestFile = 1 << 20;
}

TransferFunction read_transfer_function(const fs::path& toml_file) {
  const TomlDocument document(toml_file.string(), read_file(toml_file, kLargestFile), OnMistake::collect);
  const TomlTable root = document.root();
  TransferFunction function;
  function.name = root.text("name");
  for (const TomlTable& table : root.tables("point", kMaxTransferPoints, "point")) {
    TransferPoint point;
    point.hu = table.number("hu", {kFirstTransfer_hu, kLastTransfer_hu});
    point.colour = table.vector("colour", {0, 1});
    point.opacity = table.number("opacity", {0, kMaxOpacity});
    if (!function.points.empty() && point.hu <= function.points.back().hu)
      table.report("hu", "'hu' is not above that of the point before", "put the points in the order of rising hu");
    function.points.push_back(point);
  }
  if (function.points.size() < 2)
    root.report("point", "a transfer function needs at least 2 points", "add tables [[point]] with rising hu");
  root.refuse_unknown_keys();
  document.throw_mistakes();
  return function;
}

void write_transfer_function(const fs::path& toml_file, const TransferFunction& function) {
  std::string text = "name = " + toml_value(function.name) + "\n";
  for (const TransferPoint& point : function.points)
    text += "\n[[point]]\nhu = " + toml_value(point.hu) + "\ncolour = [" + toml_value(point.colour.r) + ", " +
            toml_value(point.colour.g) + ", " + toml_value(point.colour.b) +
            "]\nopacity = " + toml_value(point.opacity) + "\n";
  write_file(toml_file, text);
}

std::vector<TransferFunction> bundled_transfer_functions() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(assets_folder() / "transfer_functions"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());  // their names begin with a number
  std::vector<TransferFunction> functions;
  for (const fs::path& file : files) functions.push_back(read_transfer_function(file));
  return functions;
}

}  // namespace insonate::view

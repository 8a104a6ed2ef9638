#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <limits>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/ct_reader.h"
#include "sim/volume/dicom_series.h"
#include "tests/core/temporary_folder.h"
#include "tests/volume/volume_files.h"

// GCC and clang each have a word of their own for it.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define UNDER_ASAN
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define UNDER_ASAN
#endif

using namespace insonate;
namespace fs = std::filesystem;

namespace {

std::string small_voxels() {
  std::vector<std::int16_t> values(24);
  for (std::size_t v = 0; v < 24; ++v) values[v] = std::int16_t(v);
  return bytes_of_values(values);
}

std::string why_refused(const fs::path& file) {
  try {
    read_ct(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A limit of this process, while it lives.
struct Limited {
  int resource;
  rlimit before{};

  Limited(int which, rlim_t value) : resource(which) {
    getrlimit(decltype(RLIMIT_AS)(resource), &before);
    const rlimit lower{value, before.rlim_max};
    setrlimit(decltype(RLIMIT_AS)(resource), &lower);
  }
  Limited(const Limited&) = delete;
  Limited& operator=(const Limited&) = delete;
  ~Limited() { setrlimit(decltype(RLIMIT_AS)(resource), &before); }
};

struct BadFile {
  std::string name, bytes, sentence;
};

void check_refused(const std::vector<BadFile>& files) {
  const TemporaryFolder folder;
  for (const BadFile& bad : files) {
    const fs::path file = folder.path / bad.name;
    folder.put(bad.name, bad.bytes);
    const std::string why = why_refused(file);
    INFO(bad.name << " (" << bad.sentence << ") -> " << why << "\n" << bad.bytes.substr(0, 300));
    CHECK(why.find(bad.sentence) != std::string::npos);
    CHECK(why.find(file.string()) == 0);
    CHECK(why.find('\n') == std::string::npos);
  }
}

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

std::string nifti_with(const std::function<void(NiftiSpec&)>& change) {
  NiftiSpec spec;
  change(spec);
  return nifti(spec, small_voxels());
}

std::string nrrd_with(const std::string& key, const std::string& by) {
  return nrrd(with_line(nrrd_lines(), key, by), small_voxels());
}

std::string meta_with(const std::string& key, const std::string& by) {
  return meta_image(with_line(meta_lines(), key, by), small_voxels());
}

}  // namespace

TEST_CASE("a file that cannot be opened is refused, and a folder whose files cannot be looked through") {
  const TemporaryFolder folder;
  const fs::path nii = folder.put("a.nii", nifti({}, small_voxels())),
                 nrrd_file = folder.put("a.nrrd", nrrd(nrrd_lines(), small_voxels()));
  {
    const Limited limited(RLIMIT_NOFILE, 3);
    for (const fs::path& file : {nii, nrrd_file})
      CHECK(why_refused(file) == file.string() + ": header: it cannot be read; check its permissions.");
    CHECK(why_refused(folder.path).find("the folder cannot be read (Too many open files); check") != std::string::npos);
  }
  folder.put("b", "x");
  CHECK(files_below(folder.path, 3).size() == 3);
  CHECK_THROWS_WITH(files_below(folder.path, 2),
                    folder.path.string() + ": there are more than 2 files below it; name the folder of one study.");
}

TEST_CASE("a file that is not a volume is refused by name") {
  const TemporaryFolder folder;
  CHECK(why_refused(folder.path / "none.nii").find("there is no such file") != std::string::npos);
  CHECK(why_refused(folder.path).find("no DICOM images") != std::string::npos);
  CHECK(why_refused("/dev/zero").find("not an ordinary file") != std::string::npos);
  std::ofstream(folder.path / "empty.nii").close();
  CHECK(why_refused(folder.path / "empty.nii").find("empty") != std::string::npos);
  const std::string png = std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + std::string(600, 'x');
  const std::string text = "Dear radiologist,\n\nplease find enclosed the scan.\n" + std::string(600, '.');
  const std::string dicom = std::string(128, '\0') + "DICM" + std::string(600, '\0');
  for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.nhdr", "a.mha", "a.mhd"})
    check_refused(
        {{name, png, "this is not a"}, {name, text, "this is not a"}, {name, dicom, "name the folder of its series"}});
  check_refused({{"a.png", png, "does not end as a volume's does"}, {"noextension", text, "does not end as"}});
}

TEST_CASE("NIfTI files that cannot be a CT are refused with the reason") {
  const std::string good = nifti({}, small_voxels());
  check_refused({
      {"a.nii", good.substr(0, 200), "the file ends within the header"},
      {"a.nii", good + "x", "it claims 48 bytes of voxels, the file holds 49; correct the sizes"},
      {"a.nii.gz", gzip(good + "x"), "it claims 48 bytes of voxels, the file holds 49; correct the sizes"},
      {"a.nii.gz", gzip(good + std::string(17 << 20, 'x')), "the file holds more than 16"},
      {"a.nii", nifti_with([](auto& s) { s.dim[1] = 3; }), "it claims 36 bytes of voxels, the file holds 48"},
      {"a.nii", nifti_with([](auto& s) { s.datatype = 2; }), "it claims 24 bytes of voxels, the file holds 48"},
      {"a.nii", good.substr(0, 352), "it claims 48 bytes of voxels, the file holds 0"},
      {"a.nii", good.substr(0, good.size() - 1), "the file holds 47"},
      {"a.nii", bytes_of_values<std::int32_t>({540}) + std::string(540, '\0'), "this is not a NIfTI file"},
      {"a.nii", nifti_2({}, "").substr(0, 500), "the file ends within the header"},
      {"a.nii", nifti_2({}, small_voxels() + "x"), "it claims 48 bytes of voxels, the file holds 49"},
      {"a.nii.gz", gzip(good.substr(0, 200)), "the file ends within the header"},
      {"a.nii.gz", gzip(good.substr(0, good.size() - 1)), "the file holds 47"},
      {"a.nii.gz", gzip(good).substr(0, 60), "header"},
      {"a.nii", nifti_with([](auto& s) { s.dim = {3, 30000, 30000, 30000, 1, 1, 1, 1}; }), "above the limit of 4096"},
      {"a.nii", nifti_with([](auto& s) { s.dim = {3, 4096, 4096, 4096, 1, 1, 1, 1}; }), "above the limit of 2^31"},
      {"a.nii", nifti_with([](auto& s) { s.dim = {3, 1024, 1024, 1024, 1, 1, 1, 1}; }), "the file holds 48"},
      {"a.nii.gz", gzip(nifti_with([](auto& s) { s.dim = {3, 1024, 1024, 1024, 1, 1, 1, 1}; })), "cannot hold"},
      {"a.nii", nifti_with([](auto& s) { s.dim[1] = 0; }), "not a volume"},
      {"a.nii", nifti_with([](auto& s) { s.dim[2] = -3; }), "not a volume"},
      {"a.nii", nifti_with([](auto& s) { s.dim[3] = 1; }), "not a volume"},
      {"a.nii", nifti_with([](auto& s) { s.dim[0] = 0; }), "dimensions"},
      {"a.nii", nifti_with([](auto& s) { s.dim[0] = 9; }), "dimensions"},
      {"a.nii", nifti_with([](auto& s) { s.dim[0] = 2; }), "2 dimensions"},
      {"a.nii", nifti_with([](auto& s) { s.dim = {4, 2, 3, 2, 2, 1, 1, 1}; }), "more than 3 dimensions"},
      {"a.nii", nifti_with([](auto& s) { s.datatype = 128; }), "data type 128"},    // RGB
      {"a.nii", nifti_with([](auto& s) { s.datatype = 32; }), "data type 32"},      // complex
      {"a.nii", nifti_with([](auto& s) { s.datatype = 1; }), "data type 1"},        // bits
      {"a.nii", nifti_with([](auto& s) { s.datatype = 1536; }), "data type 1536"},  // long double
      {"a.nii", nifti_with([](auto& s) { s.pixdim[1] = 0; }), "the spacing along axis 1 is 0;"},
      {"a.nii", nifti_with([](auto& s) { s.pixdim[2] = -2; }), "spacing along axis 2"},
      {"a.nii", nifti_with([](auto& s) { s.pixdim[3] = kNan; }), "spacing along axis 3"},
      {"a.nii", nifti_with([](auto& s) { s.sform[0] = kNan; }), "not finite"},
      {"a.nii", nifti_with([](auto& s) { s.sform = {10, 0, 0, 10, 20, 0, 0, 20, 0, 0, 30, 30}; }), "by the sform"},
      {"a.nii", nifti_with([](auto& s) { s.sform = {0, 0, 0, 10, 0, 0, 0, 20, 0, 0, 0, 30}; }),
       "1 is 0 mm by the sform matrix and 10 mm by pixdim"},
      {"a.nii", nifti_with([](auto& s) { s.sform[1] = 2; }), "axes of the sform matrix are not at right angles"},
      {"a.nii", nifti_with([](auto& s) { s.sform[3] = -1.7e38f; }),
       "the sform matrix holds -1.7e+38, further than 1 km"},
      {"a.nii", nifti_with([](auto& s) { s.qform_code = 1, s.sform[4] = 3e38f; }), "the sform matrix holds 3e+38"},
      {"a.nii", nifti_with([](auto& s) { s.qoffset[1] = 2e6f; }), "the qform's offset holds 2e+06"},
      {"a.nii", nifti_with([](auto& s) { s.qoffset[1] = kNan; }), "the qform's offset holds nan"},
      {"a.nii", nifti_with([](auto& s) { s.units = 1; }), "its unit of length is the metre; save it in millimetres"},
      {"a.nii", nifti_with([](auto& s) { s.units = 3; }), "its unit of length is the micrometre"},
      {"a.nii", nifti_with([](auto& s) { s.intent = 1004; }), "each voxel is a matrix"},
      {"a.nii", nifti_with([](auto& s) {
         s.sform_code = 0, s.qform_code = 1, s.quaternion = {1, 1, 1};
       }),
       "quaternion"},
      {"a.nii", nifti_with([](auto& s) { s.sform_code = 0, s.qform_code = 1, s.quaternion[0] = kNan; }), "quaternion"},
      {"a.nii", nifti_with([](auto& s) { s.vox_offset = kNan; }), "voxels begin"},
      {"a.nii", nifti_with([](auto& s) { s.vox_offset = -4; }), "voxels begin"},
      {"a.nii", nifti_with([](auto& s) { s.vox_offset = 0; }), "begin at byte 0, and its header has 348 bytes"},
      {"a.nii", nifti_with([](auto& s) { s.vox_offset = 1e6; }), "the file holds 0"},
      {"a.nii.gz", gzip(nifti_with([](auto& s) { s.vox_offset = 1e4; })),
       "it claims 48 bytes of voxels, the file holds 0"},
      {"a.nii", nifti_with([](auto& s) { s.magic = std::string("ni1\0", 4); }), "this is not a NIfTI file"},
      {"a.nii", nifti_with([](auto& s) { s.slope = 1e30f; }), "its scl_slope is 1e+30"},
      {"a.nii", nifti_with([](auto& s) { s.slope = 1e-30f; }), "its scl_slope is 1e-30"},
      {"a.nii", nifti_with([](auto& s) { s.slope = -1; }), "its scl_slope is -1"},
      {"a.nii", nifti_with([](auto& s) { s.slope = kNan; }), "its scl_slope is nan"},
      {"a.nii", nifti_with([](auto& s) { s.slope = kInfinity; }), "its scl_slope is inf"},
      {"a.nii", nifti_with([](auto& s) { s.inter = 1e30f; }), "its scl_inter is 1e+30"},
      {"a.nii", nifti_with([](auto& s) { s.inter = kNan; }), "its scl_inter is nan"},
      {"a.nii", nifti_with([](auto& s) { s.inter = -kInfinity; }), "its scl_inter is -inf"},
      {"a.nii", nifti_with([](auto& s) { s.slope = 0, s.inter = -1024; }), "its scl_slope is 0"},
  });
}

TEST_CASE("NRRD files that cannot be a CT are refused with the reason") {
  const std::string voxels = small_voxels();
  const auto undirected = with_line(nrrd_lines(), "space directions", "");
  const auto gzipped = with_line(nrrd_lines(), "encoding", "encoding: gzip");
  const auto spaced =
      with_line(with_line(with_line(undirected, "space: ", ""), "space origin", ""), "spacings", "spacings: 10 20 30");
  check_refused({
      {"a.nrrd", nrrd_with("sizes", "sizes: 100000 100000 100000"), "above the limit of 4096"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 2048 2048 1024"), "above the limit of 2^31"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 4 3 20"), "it claims 480 bytes of voxels, the file holds 48"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 4 3"), "three whole numbers"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 4 3 2 1"), "three whole numbers"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 4 3 -2"), "three whole numbers"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 4 3 99999999999999999999"), "three whole numbers"},
      {"a.nrrd", nrrd_with("sizes", ""), "three whole numbers"},
      {"a.nrrd", nrrd_with("dimension", "dimension: 4"), "'4' dimensions"},
      {"a.nrrd", nrrd_with("dimension", "dimension: 99"), "'99' dimensions"},
      {"a.nrrd", nrrd_with("type", "type: block"), "the type is 'block'"},
      {"a.nrrd", nrrd_with("type", ""), "the type is ''"},
      {"a.nrrd", nrrd_with("encoding", "encoding: ascii"), "save it as raw or gzip"},
      {"a.nrrd", nrrd_with("endian", ""), "it does not give the order of its bytes; add: endian: little"},
      {"a.nrrd", nrrd_with("sizes", "sizes: 3 3 2"), "it claims 36 bytes of voxels, the file holds 48"},
      {"a.nrrd", nrrd(gzipped, gzip(voxels + "x")), "it claims 48 bytes of voxels, the file holds 49"},
      {"a.nrrd", nrrd_with("space: ", "space: middle-earth"), "the space is 'middle-earth'; write"},
      {"a.nrrd", nrrd_with("kinds", "kinds: 3-vector domain domain"), "the kinds are '3-vector domain domain'"},
      {"a.nrrd", nrrd_with("old min", "old min: -1024"), "asks for a rescale by 'old min'"},
      {"a.nrrd", nrrd_with("oldmax", "oldmax: 3071"), "asks for a rescale by 'old max'"},
      {"a.nrrd", nrrd_with("space units", R"(space units: "um" "um" "um")"),
       "its unit of length is 'um'; save it in mm"},
      {"a.nrrd", nrrd_with("units", R"(units: "mm" "mm" "cm")"), "its unit of length is 'cm'"},
      {"a.nrrd", nrrd_with("space directions", ""), "it gives no spacing; add the space directions"},
      {"a.nrrd", nrrd(with_line(undirected, "spacings", "spacings: 10 20"), voxels), "the spacings are '10 20'"},
      {"a.nrrd", nrrd(with_line(undirected, "spacings", "spacings: 10 20 0"), voxels), "spacing along axis 3 is 0"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (10,0,0) none (0,0,30)"), "three vectors"},
      {"a.nrrd", nrrd_with("byte skip", "byte skip: -1"), "byte skip"},
      {"a.nrrd", nrrd_with("spce origin", "spce origin: (1,2,3)"), "line 11: 'spce origin' is not a field of NRRD"},
      {"a.nrrd", nrrd_with("x", "Space Origin: (1,2,3)"), "line 11: 'Space Origin' is given a second time; remove"},
      {"a.nrrd", nrrd_with("type", "type short"), "line 2: 'type short' is not of the form 'name: value'"},
      {"a.nrrd", nrrd_with("kinds", "kinds: domain domain"), "the kinds are 'domain domain'"},
      {"a.nrrd", nrrd_with("space: ", ""), "it gives space directions and no space"},
      {"a.nrrd", nrrd_with("space: ", "space dimension: 2"), "it gives space directions and no space"},
      {"a.nrrd", nrrd_with("spacings", "spacings: 10 20 30"), "it gives spacings beside the space directions"},
      {"a.nrrd", nrrd_with("axis mins", "axis mins: 0 0 0"), "it gives axis mins beside the space directions"},
      {"a.nrrd", nrrd_with("space directions", "space directions: 10,0,0 0,20,0 0,0,30"), "three vectors of three"},
      {"a.nrrd", nrrd(with_line(undirected, "spacings", "spacings: 10 20 30"), voxels), "a space and no directions"},
      {"a.nrrd", nrrd(with_line(spaced, "axis mins", "axis mins: 1 nan 3"), voxels), "the axis mins are '1 nan 3'"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (10,0,0) (0,0,0) (0,0,30)"), "along axis 2 is 0"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (10,0,0) (20,0,0) (0,0,30)"), "singular"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (10,0,0) (10,20,0) (0,0,30)"), "not orthogonal"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (nan,0,0) (0,20,0) (0,0,30)"), "three vectors"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (101,0,0) (0,20,0) (0,0,30)"),
       "axis 1 is 101 mm; give a spacing"},
      {"a.nrrd", nrrd_with("space origin", "space origin: (nan,0,0)"), "the space origin is '(nan,0,0)'"},
      {"a.nrrd", nrrd_with("space origin", "space origin: (1e9,0,0)"), "origin"},
      {"a.nrrd", nrrd(gzipped, gzip(voxels).substr(0, 30)), "damaged or cut off"},
      {"a.nrrd", nrrd(gzipped, gzip(voxels.substr(0, 40))), "the file holds 40"},
      {"a.nrrd", nrrd(gzipped, voxels), "damaged or cut off"},
      {"a.nrrd", nrrd(with_line(gzipped, "sizes", "sizes: 1024 1024 1024"), gzip(voxels)), "cannot hold"},
      {"a.nhdr", nrrd_with("data file", "data file: none.raw"), "there is no data file"},
      {"a.nhdr", nrrd_with("data file", "data file: /dev/zero"), "there is no data file"},
      {"a.nhdr", nrrd_with("data file", "data file: LIST"), "several files"},
      {"a.nhdr", nrrd_with("data file", "data file: slice%03d.raw 1 2 1"), "several files"},
      {"a.nrrd", "NRRD0004\n" + std::string(3 << 20, 'x'), "the header does not end"},
  });
  std::vector<float> values(24, 1);
  for (const float bad : {kNan, std::numeric_limits<float>::infinity()}) {
    values[23] = bad;
    check_refused({{"a.nrrd", nrrd(with_line(nrrd_lines(), "type", "type: float"), bytes_of_values(values)),
                    "voxel (3, 2, 1): the value is not a finite number"}});
    NiftiSpec spec;
    spec.datatype = 16;
    check_refused({{"a.nii", nifti(spec, bytes_of_values(values)), "voxel (3, 2, 1): the value is not a finite"}});
  }
}

TEST_CASE("MetaImage files that cannot be a CT are refused with the reason") {
  const std::string voxels = small_voxels();
  const auto packed = [](const std::string& data) { return packed_meta_lines(data); };
  const std::string zipped = zlib(voxels);
  check_refused({
      {"a.mha", meta_with("DimSize", "DimSize = 100000 100000 100000"), "above the limit of 4096"},
      {"a.mha", meta_with("DimSize", "DimSize = 4 3 20"), "it claims 480 bytes of voxels, the file holds 48"},
      {"a.mha", meta_with("DimSize", "DimSize = 4 3"), "three whole numbers"},
      {"a.mha", meta_with("DimSize", "DimSize = 4 3 -2"), "three whole numbers"},
      {"a.mha", meta_with("NDims", "NDims = 100"), "'100' dimensions"},
      {"a.mha", meta_with("NDims", "NDims = -1"), "'-1' dimensions"},
      {"a.mha", meta_with("NDims", ""), "the image has '' dimensions"},
      {"a.mha", meta_with("ElementType", "ElementType = MET_STRING"), "the ElementType is 'MET_STRING'"},
      {"a.mha", meta_with("ElementNumberOfChannels", "ElementNumberOfChannels = 3"), "3 components"},
      {"a.mha", meta_with("BinaryData ", "BinaryData = False"), "written as text"},
      {"a.mha", meta_with("HeaderSize", "HeaderSize = -1"), "HeaderSize"},
      {"a.mha", meta_with("BinaryDataByteOrderMSB", "BinaryDataByteOrderMSB = yes"), "MSB is 'yes' instead of True"},
      {"a.mha", meta_with("ElementType", "junk"), "line 11: 'junk' is not of the form 'name = value'"},
      {"a.mha", meta_image(meta_lines(), voxels, ""), "the ElementDataFile is ''"},
      {"a.mha", meta_with("ElementSpacing", "ElementSpacing = 0 20 30"), "the spacing along axis 1 is 0;"},
      {"a.mha", meta_with("ElementSpacing", "ElementSpacing = -10 20 30"), "the spacing along axis 1 is -10;"},
      {"a.mha", meta_with("ElementSpacing", "ElementSpacing = 1 nan 3"), "the ElementSpacing is '1 nan 3'"},
      {"a.mha", meta_with("ElementSpacing", ""), "it gives no ElementSpacing"},
      {"a.mha", meta_with("DimSize", "DimSize = 3 3 2"), "it claims 36 bytes of voxels, the file holds 48"},
      {"a.mha", meta_image(packed(zlib(voxels + "x")), zlib(voxels + "x")),
       "it claims 48 bytes of voxels, the file holds 49"},
      {"a.mha", meta_with("DistanceUnits", "DistanceUnits = um"), "its unit of length is 'um'; save it in mm"},
      {"a.mha", meta_with("ElementToIntensityFunctionSlope", "ElementToIntensityFunctionSlope = 2"), "ToIntensity"},
      {"a.mha", meta_with("ElementToIntensityFunctionOffset", "ElementToIntensityFunctionOffset = nan"), "ToIntensity"},
      {"a.mha", meta_with("Offset", "Offset = 1 2"), "the Offset is '1 2'"},
      {"a.mha", meta_with("TransformMatrix", "TransformMatrix = 1 0 0 1 0 0 0 0 1"), "singular"},
      {"a.mha", meta_with("TransformMatrix", "TransformMatrix = 1 0 0 0 0 0 0 0 1"), "singular"},
      {"a.mha", meta_with("TransformMatrix", "TransformMatrix = 1 0 0 1 1 0 0 0 1"), "not orthogonal"},
      {"a.mha", meta_with("TransformMatrix", "TransformMatrix = nan 0 0 0 1 0 0 0 1"), "the TransformMatrix is 'nan"},
      {"a.mha", meta_with("Offset", "Offset = 1e30 0 0"), "origin"},
      {"a.mha", meta_image(packed(voxels), voxels), "damaged or cut off"},
      {"a.mha", meta_image(with_line(meta_lines(), "CompressedData", "CompressedData = True"), zipped),
       "it gives no CompressedDataSize; write 'CompressedDataSize = " + std::to_string(zipped.size()) + "'"},
      {"a.mha", meta_image(packed(zipped + "x"), zipped), "the CompressedDataSize is"},
      {"a.mha", meta_image(packed(zipped.substr(1)), zipped), "the CompressedDataSize is"},
      {"a.mha", meta_image(with_line(packed(voxels), "DimSize", "DimSize = 1024 1024 1024"), voxels), "cannot hold"},
      {"a.mhd", meta_image(meta_lines(), "", "none.raw"), "there is no data file"},
      {"a.mhd", meta_image(meta_lines(), "", "LIST"), "several files"},
      {"a.mhd", meta_image(meta_lines(), "", "slice%03d.raw 1 2 1"), "several files"},
  });
}

TEST_CASE("a volume that cannot be a person's CT is refused, and asks about the unit or the rescale") {
  const auto sized = [](float spacing, std::int16_t voxels_along_i) {
    NiftiSpec spec;
    spec.dim = {3, voxels_along_i, 3, 2, 1, 1, 1, 1};
    spec.pixdim = {1, spacing, spacing, spacing, 1, 1, 1, 1};
    spec.sform = {spacing, 0, 0, 10, 0, spacing, 0, 20, 0, 0, spacing, 30};
    std::vector<std::int16_t> values(std::size_t(voxels_along_i) * 6);
    values[0] = 60;
    return nifti(spec, bytes_of_values(values));
  };
  const auto valued = [](const std::vector<float>& first) {
    std::vector<float> values(24, first.back());
    std::copy(first.begin(), first.end(), values.begin());
    return nrrd(with_line(nrrd_lines(), "type", "type: float"), bytes_of_values(values));
  };
  const std::string unit = "; is its spacing in mm, and not in another unit?";
  check_refused({
      {"a.nii", sized(0.0015f, 4), "the volume measures 0.006 x 0.0045 x 0.003 mm, where a body has 20 to 3000"},
      {"a.nii", sized(0.0015f, 4), unit},
      {"a.nii", sized(100, 31), "the volume measures 3100 x 300 x 200 mm, where a body has 20 to 3000 mm along each"},
      {"a.nii", sized(9.9f, 4), "the volume measures 39.6 x 29.7 x 19.8 mm"},
      {"a.nrrd", nrrd_with("space directions", "space directions: (0.01,0,0) (0,0.02,0) (0,0,0.03)"), unit},
      {"a.mha", meta_with("ElementSpacing", "ElementSpacing = 0.01 0.02 0.03"), unit},
      {"a.nrrd", valued({40}), "voxels: all voxels have the same value, 40 HU; check the rescale"},
      {"a.nrrd", valued({-1e30f, -1e20f}), "all voxels have the same value, -1024 HU"},
      {"a.nrrd", valued({-1000, -301}), "the values reach from -1000 to -301 HU, where those of a body reach"},
      {"a.nrrd", valued({4000, 3072}), "the values reach from 3072 to 4000 HU, where those of a body reach"},
      {"a.nrrd", valued({1e30f, 1e30f, 1e30f, 0}), "12 % of the voxels are above 32767 HU"},
  });
  const TemporaryFolder folder;
  for (const auto& bytes : {sized(10, 4), sized(99, 30)}) CHECK(why_refused(folder.put("a.nii", bytes)).empty());
  for (const auto& bytes : {valued({-1000, -300}), valued({4000, 3071}), valued({1e30f, 1e30f, 0})})
    CHECK(why_refused(folder.put("a.nrrd", bytes)).empty());
}

TEST_CASE("a label map is refused as a CT, and says what to do with it") {
  // The values in turn, each in more than 200 voxels.
  const auto file_of = [](const std::vector<float>& values) {
    NiftiSpec spec;
    spec.dim = {3, 30, 30, 30, 1, 1, 1, 1};
    spec.datatype = 16;  // float, which holds integers too
    spec.bits = 32;
    std::vector<float> voxels;
    for (std::size_t i = 0; i < 27000; ++i) voxels.push_back(values[i % values.size()]);
    return nifti(spec, bytes_of_values(voxels));
  };
  check_refused(
      {{"a.nii", file_of({0, 1, 5, 20}),
        "a.nii: voxels: this is a label map, not a CT: it has 4 different values, all whole numbers from 0 to "
        "20; open the CT that it belongs to, or make a case of both with 'insonate-case import"},
       {"a.nii", file_of({0, 255}), "2 different values, all whole numbers from 0 to 255"}});
  const TemporaryFolder folder;
  for (const std::vector<float>& ct : {std::vector<float>{0, 1, 5, -1}, {0, 1, 5, 0.5f}, {0, 1, 5, 256}})
    CHECK(why_refused(folder.put("a.nii", file_of(ct))).empty());
  std::vector<float> many(129);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = float(i);
  CHECK(why_refused(folder.put("a.nii", file_of(many))).empty());
}

TEST_CASE("a volume that does not fit into memory is refused") {
#ifndef UNDER_ASAN  // whose own memory would count
  const TemporaryFolder folder;
  NiftiSpec spec;
  spec.dim = {3, 512, 512, 128, 1, 1, 1, 1};
  spec.pixdim = {1, 1, 1, 1, 1, 1, 1, 1};
  spec.sform = {1, 0, 0, 10, 0, 1, 0, 20, 0, 0, 1, 30};
  const fs::path file = folder.put("a.nii.gz", gzip(nifti(spec, std::string(std::size_t(1) << 26, '\0'))));
  unsigned long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const Limited limited(RLIMIT_AS, rlim_t(pages) * rlim_t(sysconf(_SC_PAGESIZE)) + (rlim_t(32) << 20));
  const std::string why = why_refused(file);
  INFO(why);
  CHECK(why.find(": there is not enough memory for it; resample it") != std::string::npos);
#endif
}

TEST_CASE("a volume that cannot be written is refused") {
  const TemporaryFolder folder;
  const Volume<std::uint8_t> labels{{{64, 64, 64}}, std::vector<std::uint8_t>(std::size_t(64) * 64 * 64)};
  std::signal(SIGXFSZ, SIG_IGN);
  const Limited limited(RLIMIT_FSIZE, 4096);
  CHECK_THROWS_WITH(write_labels(folder.path / "a.nrrd", labels),
                    Catch::Contains("a.nrrd: it cannot be written; check"));
  CHECK(fs::is_empty(folder.path));
}

TEST_CASE("a volume file cut anywhere or with bytes changed is read or refused") {
  const std::string voxels = small_voxels();
  const auto gzipped = with_line(nrrd_lines(), "encoding", "encoding: gzip");
  const struct {
    std::string name, bytes;
  } files[] = {
      {"a.nii", nifti({}, voxels)},
      {"a.nii.gz", gzip(nifti({}, voxels))},
      {"a.nrrd", nrrd(nrrd_lines(), voxels)},
      {"b.nrrd", nrrd(gzipped, gzip(voxels))},
      {"a.mha", meta_image(meta_lines(), voxels)},
      {"b.mha", meta_image(packed_meta_lines(zlib(voxels)), zlib(voxels))},
  };
  const TemporaryFolder folder;
  std::uint32_t state = 1;
  const auto random = [&](std::size_t below) {
    return std::size_t((state = state * 1664525u + 1013904223u) >> 8) % below;
  };
  for (const auto& file : files) {
    INFO(file.name);
    const fs::path path = folder.path / file.name;
    folder.put(file.name, file.bytes);
    CHECK(why_refused(path).empty());
    for (std::size_t part = 1; part < 16; ++part) {
      folder.put(file.name, file.bytes.substr(0, std::max<std::size_t>(1, file.bytes.size() * part / 16)));
      INFO("the first " << part << "/16");
      CHECK_FALSE(why_refused(path).empty());
    }
    int refused = 0;
    for (int round = 0; round < 1000; ++round) {
      std::string bytes = file.bytes;
      for (std::size_t flips = 1 + random(3); flips > 0; --flips) bytes[random(bytes.size())] = char(random(256));
      folder.put(file.name, bytes);
      refused += !why_refused(path).empty();
    }
    CHECK(refused > 0);
    CHECK(refused < 1000);
  }
}

// What tools/check-braces has to find, and what it has to leave alone: it fails unless it reports exactly the lines
// that are marked here. g++ 12 destroys `text` twice in each of them when what comes later throws. Not part of any
// program.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Part {
  std::string text;
  int number = 0;
};
struct Whole {
  Part part;
  std::string rest;
};
struct Outermost {
  Whole whole;
  std::string rest;
};
struct Derived : Part {
  std::string rest;
};
template <typename T>
struct PartOf {
  T text;
  int number;
};
template <typename T>
struct WholeOf {
  PartOf<T> part;
  T rest;
};
struct Handle {
  ~Handle();
  std::string text;
  int number;
};
struct WithHandle {
  Handle handle;
  std::string rest;
};

std::string text();
void take(const Whole& whole);

struct DefaultInBraces {
  Part part{"text", 1};  // found
  std::string rest = text();
};
struct DefaultNamed {
  Part part = Part{"text", 1};  // found
  std::string rest = text();
};
struct DefaultEmpty {
  Part part{};  // found
  std::string rest = text();
};

struct Returned {
  Whole returned() { return {{text(), 1}, text()}; }                      // found
  Whole without_number() { return {{text()}, text()}; }                   // found
  Whole by_name() { return {.part = {.text = text()}, .rest = text()}; }  // found
  Whole without_inner_braces() { return {text(), 1, text()}; }            // found
  Whole without_part() { return {.rest = text()}; }                       // found
  Whole outer_is_named() { return Whole{{text(), 1}, text()}; }           // found
  Outermost deeper() { return {Whole{{text(), 1}, text()}, text()}; }     // found
  Derived base_class() { return {{text(), 1}, text()}; }                  // found
  WithHandle destructor_elsewhere() { return {{text(), 1}, text()}; }     // found
  WholeOf<std::string> of_template() { return {{text(), 1}, text()}; }    // found
};

template <typename T>
void in_template() {
  const T whole{{text(), 1}, text()};  // found
  take(whole);
}

struct Member {
  Member() : whole{{text(), 1}, text()} {}  // found
  Whole whole;
};

void statements(bool first) {
  in_template<Whole>();
  Whole local{{text(), 1}, text()};                                   // found
  local = {{text(), 1}, text()};                                      // found
  take({{text(), 1}, text()});                                        // found
  take(first ? Whole{{text(), 1}, text()} : local);                   // found
  const auto captured = [whole = Whole{{text(), 1}, text()}] {};      // found
  const auto in_lambda = [] { return Whole{{text(), 1}, text()}; };   // found
  const std::unique_ptr<Whole> made(new Whole{{text(), 1}, text()});  // found
  const Whole several[] = {{{text(), 1}, text()}};                    // found
  std::vector<Whole> list;
  list.push_back({{text(), 1}, text()});                             // found
  list.emplace_back(Whole{{text(), 1}, text()});                     // found
  const std::vector<Whole> listed{{{text(), 1}, text()}};            // found
  const std::map<int, Whole> by_number{{1, {{text(), 1}, text()}}};  // found
  const std::optional<Whole> maybe = Whole{{text(), 1}, text()};     // found
  throw Whole{{text(), 1}, text()};                                  // found
}

// Named in front of its braces, a part is cleaned up once. So are parts that own nothing, the last part, elements of
// arrays and lists, and what has no braces at all.
struct PartLast {
  std::string rest;
  Part part;
};
struct Position {
  double x_mm = 0, y_mm = 0;
};
struct Placed {
  Position position;
  std::string rest;
};
struct DefaultWithoutBraces {
  std::string same{text()};
  Part part;
  Part other = Part();
  std::string rest = text();
};

struct ReturnedWell {
  Whole part_is_named() { return {Part{text(), 1}, text()}; }
  Whole part_is_value() { return {Part(), text()}; }
  Outermost both_are_named() { return {Whole{Part{text(), 1}, text()}, text()}; }
  Derived base_is_named() { return {Part{text(), 1}, text()}; }
  Placed owns_nothing() { return {{1, 2}, text()}; }
  PartLast last() { return {text(), {text(), 1}}; }
  std::vector<Part> elements() { return {{text(), 1}, {text(), 2}}; }
  std::pair<Part, std::string> pair() { return {{text(), 1}, text()}; }
};

void without_braces() {
  Part part{text(), 1};
  take({std::move(part), text()});
  take(Whole());
}

}  // namespace

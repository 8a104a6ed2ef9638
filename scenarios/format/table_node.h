#pragma once

#include <toml++/toml.h>

namespace insonate {

/// What TableReader reads, apart from it: the parser's header is large, and few files need it.
struct TableNode {
  const toml::table* table;
};

}  // namespace insonate

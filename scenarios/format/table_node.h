#pragma once

#include <toml++/toml.h>

namespace insonate {

/// The table that TableReader reads. It has its own header because the parser's header is large and few files need it.
struct TableNode {
  const toml::table* table;
};

}  // namespace insonate

// Test programs write and read tables without loading the module.
#include "tables/module.hpp"

namespace {

[[maybe_unused]] bool const is_linked = [] {
    pogosim::link_tables_module(pogosim::get_tables_module);
    return true;
}();

}  // namespace

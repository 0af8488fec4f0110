#pragma once

#include "record/tables_module.hpp"

namespace pogosim {

/// The functions of this module, for the process of the host.
TablesModule const* get_tables_module(TablesHost const& host);

}  // namespace pogosim

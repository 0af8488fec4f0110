// The function of the module libpogosim_view that libpogosim loads when a window is wanted. The two are built together.
#pragma once

#include "pogosim/version.h"
#include "view/exchange.hpp"

namespace pogosim {

/// Opens a window and shows the run in it until it is closed, in the thread that calls it. Reports to the exchange.
using ShowWindow = void (*)(WindowSetup const& setup, Exchange& exchange);

inline constexpr char const* kShowWindowName = "pogosim_show_window";

/// The file, beside that of libpogosim.
#ifdef __APPLE__
inline constexpr char const* kModuleFile = "libpogosim_view-" POGOSIM_VERSION_STRING ".dylib";
#else
inline constexpr char const* kModuleFile = "libpogosim_view-" POGOSIM_VERSION_STRING ".so";
#endif

}  // namespace pogosim

// The module that test programs load in place of libpogosim_view.
#include "sim/window_script.hpp"
#include "view/module.hpp"

extern "C" __attribute__((visibility("default"))) void pogosim_show_window(pogosim::WindowSetup const& setup,
                                                                           pogosim::Exchange& exchange) {
    exchange.report_opened("");
    pogosim::WindowEnd const end = pogosim::testing::window_script(setup, exchange);
    exchange.report_end(end, end == pogosim::WindowEnd::failed ? "the script says so" : "");
}

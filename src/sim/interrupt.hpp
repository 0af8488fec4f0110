// Ctrl-C and its relatives (SIGINT, SIGTERM, SIGHUP, and SIGXCPU of `ulimit -St`): the run ends after the present step,
// with a complete data file.
#pragma once

namespace pogosim {

/// Catches the signals from now on, and ignores SIGPIPE. The first one asks the run to end; a second one also leaves
/// user code that hangs.
void catch_interrupts();

/// True once one of them has come.
bool interrupted();

}  // namespace pogosim

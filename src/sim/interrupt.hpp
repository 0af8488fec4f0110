// Ctrl-C and its relatives (SIGINT, SIGTERM, SIGHUP, SIGXCPU): the run ends after the present step, with a complete
// data file. Before the first robot runs, the program ends at once.
#pragma once

namespace pogosim {

/// Catches the signals from now on, and lets nothing end at SIGPIPE and SIGXFSZ. The first one asks the run to end and
/// hurries user code that does not return; a second one leaves it; a third one ends the program, complete or not.
void catch_interrupts();

/// The run is over: the signals end the program again.
void release_interrupts();

/// True once one of them has come.
bool interrupted();

}  // namespace pogosim

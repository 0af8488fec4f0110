// Ctrl-C and its relatives (SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2, SIGQUIT): the run ends after the
// present step, with a complete data file. Before the first robot runs, and after the run, the program ends at once.
#pragma once

namespace pogosim {

/// From now on, a console that is closed, full or no longer read does not end the run. Closed descriptors from 0 to 2
/// are opened to /dev/null, so that no file of the run gets one of these numbers and the console output.
void ignore_broken_outputs();

/// Catches the signals from now on, as long as the program sets no handler of its own. The first one asks the run to
/// end and hurries user code that does not return; a second one leaves it; a third one ends the program, complete or
/// not.
void catch_interrupts();

/// Lets these signals wait, also while this process becomes another program, until release_interrupts().
void hold_interrupts();
void release_interrupts();

}  // namespace pogosim

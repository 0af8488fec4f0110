// The message of a program that ends at once, because nothing can be relied on after a crash. It is composed in a
// signal handler, before anything else is tried, and only states what is certain at the current stage of the program.
#pragma once

#include <string>

#include "process/signal_text.hpp"

namespace pogosim {

enum class RunStage {
    hosted,       // the process is not ours
    before_main,  // static constructors
    preparing,    // the configuration is read and the world is built; no user code
    running,      // from the first call of main() to the end of the data file
    finished      // atexit() and static destructors
};

enum class DataFileState { none, open, complete };

void enter_stage(RunStage stage);
RunStage run_stage();

/// The state of the data file of the run for which this thread works, for the message.
void note_data_file(std::string const& path, DataFileState state);

struct DataFileNote;

/// The run is over; crash messages still name its data file.
void keep_data_file_note(DataFileNote const& note);

using CrashMessage = SignalText<4096>;

/// Composes the message. It starts with what is certain and adds details one by one: any access to memory that user
/// code may have corrupted can be the last. For signal handlers.
void prepare_crash_message(char const* what, bool in_other_thread);

/// Composes the message of a program that ends although nothing has failed.
void prepare_plain_message(char const* what);

/// Composes the message of a program that a signal ends before or after the run.
void prepare_interrupt_message(char const* signal_name);

/// Prints the message and ends the program. For signal handlers.
[[noreturn]] void end_with_crash_message(int code);

}  // namespace pogosim

#include "process/crash_message.hpp"

#include <atomic>
#include <cstring>

#include "base/escaped.hpp"
#include "base/scratch_file.hpp"
#include "process/crash_handler_state.hpp"
#include "process/process.hpp"
#include "process/running_code.hpp"

namespace pogosim {

namespace {

using Words = CrashMessage;

std::atomic<RunStage> stage = RunStage::hosted;
DataFileNote kept_data_file;  // of the run that is over
Words words_outside_runs;

Words& crash_message() {
    return active_handler != nullptr ? active_handler->crash_message : words_outside_runs;
}

DataFileNote const& data_file_note() {
    CrashHandlerState const* run = active_handler != nullptr ? active_handler : process_run.load();
    if (run == nullptr) {
        return kept_data_file;
    }
    return run->helped != nullptr ? run->helped->data_file : run->data_file;
}

void append_data_file(Words& words) {
    DataFileNote const& note = data_file_note();
    if (note.state != DataFileState::none) {
        words << " The data file '" << note.path.data()
              << (note.state == DataFileState::complete
                      ? "' is complete."
                      : "' could not be completed; recover its rows with pogosim-recover.");
    }
}

char const* place_outside_run(bool in_other_thread, char const* else_where) {
    return in_other_thread ? "a thread that it started" : else_where;
}

Words words_before_main(char const* what, bool in_other_thread) {
    Words words;
    words << "pogosim: the user program failed before main(), in "
          << place_outside_run(in_other_thread,
                               "the constructor of a static object or another function that runs there")
          << ": " << what << ". The run did not start.";
    return words;
}

Words words_of_preparation(char const* what) {
    Words words;
    words << "pogosim: the program failed before the first robot ran: " << what << ". The run did not start.";
    return words;
}

Words words_after_run(char const* what, bool in_other_thread) {
    Words words;
    words << "pogosim: the user program failed after the run, in "
          << place_outside_run(in_other_thread, "the destructor of a static object or another function that runs there")
          << ": " << what << ".";
    append_data_file(words);
    return words;
}

Words words_of_run(char const* where, char const* what, char const* advice) {
    Words words;
    words << "pogosim: the user program failed" << where << ": " << what << ".";
    append_data_file(words);
    words << " If the program writes to memory it does not own, build it with -fsanitize=address to find out where."
          << advice;
    return words;
}

void prepare_words_of_run(char const* what) {
    crash_message() = words_of_run("", what, "");
    if (active_handler == nullptr || !active_handler->running.is_known()) {
        return;
    }
    RunningCode const& code = active_handler->running;
    SignalText<256> advice;
    PlaceText where;
    where << " in " << code.stage().c_str();
    crash_message() = words_of_run(where.c_str(), what, advice.c_str());
    if (data_file_note().state == DataFileState::open) {
        advice << " For the data up to that point, " << code.how_to_repeat().c_str();
    }
    crash_message() = words_of_run(where.c_str(), what, advice.c_str());
    PlaceText exact;
    exact << " in " << code.place().c_str();
    crash_message() = words_of_run(exact.c_str(), what, advice.c_str());
}

}  // namespace

void enter_stage(RunStage next) {
    stage = next;
}

RunStage run_stage() {
    return stage;
}

void note_data_file(std::string const& path, DataFileState state) {
    if (active_handler != nullptr) {
        DataFileNote& note = active_handler->data_file;
        std::strncpy(note.path.data(), escaped(path).c_str(), note.path.size() - 1);
        note.state = state;
    }
}

void keep_data_file_note(DataFileNote const& note) {
    kept_data_file.path = note.path;
    kept_data_file.state = note.state.load();
}

void prepare_crash_message(char const* what, bool in_other_thread) {
    bool const is_in_run = active_handler != nullptr;
    switch (is_in_run ? RunStage::running : stage.load()) {
        case RunStage::before_main:
            crash_message() = words_before_main(what, in_other_thread);
            break;
        case RunStage::hosted:
        case RunStage::preparing:
            crash_message() = words_of_preparation(what);
            break;
        case RunStage::finished:
            crash_message() = words_after_run(what, in_other_thread);
            break;
        case RunStage::running:
            if (in_other_thread) {
                crash_message() = words_of_run(" in a thread that it started", what, "");
            } else {
                prepare_words_of_run(what);
            }
            break;
    }
}

void prepare_plain_message(char const* what) {
    crash_message() = {};
    crash_message() << "pogosim: " << what << ".";
    append_data_file(crash_message());
}

void prepare_interrupt_message(char const* signal_name) {
    crash_message() = {};
    crash_message() << "pogosim: " << signal_name;
    switch (stage) {
        case RunStage::hosted:
        case RunStage::before_main:
            crash_message() << " before main(), where constructors of static objects run: this run has no data file.";
            break;
        case RunStage::preparing:
        case RunStage::running:
            crash_message() << " before the first robot ran: this run has no data file.";
            break;
        case RunStage::finished:
            crash_message() << " after the run, while destructors of static objects and exit handlers ran.";
            append_data_file(crash_message());
            break;
    }
}

void end_with_crash_message(int code) {
    crash_message() << "\n";
    crash_message().write_to_stderr();
    remove_scratch_files();
    end_process(code);
}

}  // namespace pogosim

// Return values of functions of pogosim/host.h: no exception crosses into the host.
#pragma once

#include <exception>
#include <mutex>
#include <new>
#include <string>

#include "base/escaped.hpp"
#include "base/floating_point.hpp"
#include "base/memory.hpp"
#include "base/problems.hpp"
#include "host/hosted_run.hpp"

namespace pogosim {

/// The text of pogosim_host_error() in this thread.
inline std::string& error_text() {
    static thread_local std::string text;
    return text;
}

inline int failed(std::string const& what, int status = POGOSIM_USAGE) {
    error_text() = escaped(what);
    return status;
}

/// Keeps a line for each mistake.
inline int failed(ConfigErrors const& errors) {
    error_text().clear();
    for (std::string const& message : errors.messages()) {
        error_text() += (error_text().empty() ? "" : "\n") + escaped(message);
    }
    return POGOSIM_USAGE;
}

/// Runs a function that may throw, and returns its status.
template <class Body>
int with_status(Body const& body) {
    StandardFloatingPoint const mode;
    try {
        return body();
    } catch (RunFailure const& failure) {
        return failed(failure.what(), failure.code == ExitCode::user_program ? POGOSIM_PROGRAM_FAILED : POGOSIM_USAGE);
    } catch (std::bad_alloc const&) {
        return failed(kOutOfMemory);
    } catch (ConfigErrors const& errors) {
        return failed(errors);
    } catch (std::exception const& error) {
        return failed(error.what());
    } catch (...) {
        return failed("unknown error");
    }
}

/// The same for a function that needs the run for itself.
template <class Body>
int with_status_of(pogosim_run const& run, Body const& body) {
    std::lock_guard const lock(run.in_use);
    return with_status(body);
}

}  // namespace pogosim

// Code of users that may compute, but change nothing outside of its process.
#pragma once

namespace pogosim {

/// From now on, until it ends, the calling thread, and each thread and process that it starts, can read files but
/// change none: it cannot open one for writing, nor make, rename or remove one, nor reach the network or other
/// processes, nor start another program. All system calls but those that are known to do nothing of this fail with
/// EPERM, and new ones as if the system did not have them. What is open already stays writable. A call that ends this
/// process leaves user code instead, see leave_ending_process(). False if the system cannot do this (it needs seccomp,
/// which Linux has): then nothing has changed.
bool forbid_effects_of_thread();

}  // namespace pogosim

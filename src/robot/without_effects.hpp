// Code of users that may compute, but change nothing outside of its process.
#pragma once

namespace pogosim {

/// From now on, until it ends, the calling thread, and each thread and process that it starts, can read files but
/// change none: it cannot open one for writing, nor make, rename or remove one, nor reach the network, nor start
/// another program. Such calls fail with EPERM. What is open already stays writable. False if the system cannot do this
/// (it needs seccomp, which Linux has): then nothing has changed.
bool forbid_effects_of_thread();

}  // namespace pogosim

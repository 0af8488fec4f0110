// main() of pogosim-without-program, which runs configurations that need no program: firmware and scripts.
#include "pogosim/program.h"
#include "pogosim/version.h"

static size_t const no_user_data = 0;
static void (*no_constructor)(void*) = NULL;
static struct pogosim_program const no_program = {
    .interface_version = POGOSIM_VERSION_COMPILED,
    .main = NULL,
    .user_data_bytes = &no_user_data,
    .construct_user_data = &no_constructor,
    .for_sdk = NULL,
};

__attribute__((constructor(101))) static void guard_process(void) {
    pogosim_guard_process();
}

int main(int argc, char** argv) {
    return pogosim_run_program(&no_program, argc, argv);
}

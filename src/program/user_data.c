// `mydata` of programs that declare it by hand, or have REGISTER_USERDATA alone: a variable of the program. It is
// linked only into programs that refer to it.
#include "pogosim/program.h"
#include "pogosim/shared_state.h"

extern void* mydata;
POGO_SHARED void* mydata = NULL;

__attribute__((constructor(101))) static void give_mydata(void) {
    pogosim_give_mydata(&mydata);
}
POGO_OWN_INITIALIZER(give_mydata)

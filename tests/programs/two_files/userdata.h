// The user data of a program of two files.
#ifndef USERDATA_H
#define USERDATA_H

#include "pogobase.h"

typedef struct {
    uint32_t count;
} Userdata;
DECLARE_USERDATA(Userdata);

#ifdef __cplusplus
extern "C"
#endif
    void
    count_up(void);

#endif

/// @file
/// User data: the variables of one robot. In the simulator `mydata` points to the block of the robot that has the
/// processor; on a real robot it is the address of a global, which the compiler folds away.
///
///     typedef struct { uint8_t age; } USERDATA;
///     DECLARE_USERDATA(USERDATA);    // beside the struct, wherever it is needed
///     REGISTER_USERDATA(USERDATA);   // once per program
///
/// Both work with and without the semicolon. All bytes are zero at the start.
#ifndef POGOSIM_USERDATA_H
#define POGOSIM_USERDATA_H

#ifdef REAL_ROBOT

#define DECLARE_USERDATA(T) extern T myuserdata;
#define REGISTER_USERDATA(T) T myuserdata;
#define mydata (&myuserdata)

#else

/// Declares `mydata`, a pointer to the T of the robot that runs; in each file of the program that uses it.
#define DECLARE_USERDATA(T) extern POGO_PER_ROBOT T* mydata;
/// Defines `mydata`; once per program.
#define REGISTER_USERDATA(T)                     \
    POGO_SHARED size_t UserdataSize = sizeof(T); \
    POGO_PER_ROBOT T* mydata = 0;

#endif

#endif

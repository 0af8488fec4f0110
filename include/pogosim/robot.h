/// @file
/// A C++ header of the original simulator, which is not there: programs know the simulator by functions in C.
#error \
    "pogosim/robot.h is the original simulator's own, in C++. Include pogobase.h, and pogosim/world.h \
for what a supervisor may do with the world (docs/supervisor.md)"

// Variables that C++ has once in a process.
inline int of_all_files = 1;
template <class T>
T of_template = 0;
static int of_this_file = 2;

extern "C" int robot_step(int of) {
    of_template<int> += of;
    return ++of_all_files + of_template<int> + ++of_this_file;
}

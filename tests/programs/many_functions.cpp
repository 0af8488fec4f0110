// A program with as many functions as FUNCTIONS says, each with variables of its own and a copy of the next one.
namespace swarm {

template <int number>
struct Part {
    static inline int calls;

    static inline int step(int by) {
        static int steps;
        steps += by;
        calls++;
        return steps + Part<number - 1>::step(by);
    }
};

template <>
struct Part<0> {
    static int step(int by) { return by; }
};

}  // namespace swarm

extern "C" int step_all(int by) {
    return swarm::Part<FUNCTIONS>::step(by);
}

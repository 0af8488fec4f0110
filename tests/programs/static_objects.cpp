// Robots whose variables are static objects that own memory, as in programs in C++ for the robots alone. Each of them
// fills its own, and looks whether what is in them is its own.
#include <string>
#include <vector>

#include "pogobot.h"
#ifdef SIMULATOR
#include "pogosim/simulation.h"
#endif

namespace {

int constructed() {
    static int count = 0;
    return ++count;
}

// Says when it is destroyed: once, with the process.
struct Witness {
    int number = constructed();
    ~Witness() { printf("destroyed %d\n", number); }
};

Witness witness;
std::vector<int> numbers{-1};
std::string name = "robot " + std::to_string(constructed());
int32_t gain = constructed() * 10;

std::vector<int>& steps() {
    static std::vector<int> all(3, 7);  // constructed by each robot when it comes here
    return all;
}

int noted;
__attribute__((constructor)) void note() {
    ++noted;
}

bool are_all(std::vector<int> const& values, std::size_t first, int number) {
    for (std::size_t i = first; i < values.size(); ++i) {
        if (values[i] != number) {
            return false;
        }
    }
    return true;
}

}  // namespace

int main() {
    int const id = pogobot_helper_getid();
    pogobot_init();
#ifdef SIMULATOR
    init_from_configuration(gain);
#endif
    name += " is " + std::to_string(id) + std::string(100 + id, '.');
    for (int turn = 0;; ++turn) {
        numbers.push_back(id);
        steps().push_back(id);
        if (turn == 9) {
            bool const own = are_all(numbers, 1, id) && are_all(steps(), 3, id);
            std::string const expected = "robot 2 is " + std::to_string(id) + std::string(100 + id, '.');
            printf("%d: %s, %d numbers, %d steps, %s, witness %d, noted %d, gain %d\n", id,
                   own ? "own" : "another robot's", int(numbers.size()), int(steps().size()),
                   name == expected ? "own name" : name.c_str(), witness.number, noted, int(gain));
        }
        msleep(20 + id);
    }
}

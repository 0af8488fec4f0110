// Every kind of variable of a C++ program. What pogosim-shared-state is to find is marked "found" with name and bytes.
#include <array>
#include <iostream>
#include <vector>

#include "pogobase.h"

struct Userdata {
    uint32_t steps;
};
DECLARE_USERDATA(Userdata)
REGISTER_USERDATA(Userdata)

namespace {
uint32_t unnamed_counter;  // found: unnamed_counter 4
float unnamed_gain = 1.0f;
}  // namespace

namespace limits {
static float low = 0.0f;
float high = 1.0f;
float gain = 3.0f;  // found: limits::gain 4
namespace inner {
uint8_t level = 1;
uint8_t peak = 1;  // found: limits::inner::peak 1
}  // namespace inner
void read();
}  // namespace limits

float gain = 2.0f;
std::array<float, 3> weights = {1.0f, 2.0f, 3.0f};
std::vector<int> heard;                     // found: heard 24
std::vector<int> const primes = {2, 3, 5};  // the same for all, before the first robot starts
constexpr int limit = 5;
inline uint16_t inline_counter = 1;  // found: inline_counter 2
POGO_SHARED inline uint16_t inline_total = 1;
thread_local uint32_t scratch;

class Memory {
public:
    static inline uint32_t inline_count = 1;  // found: Memory::inline_count 4
    static constexpr uint32_t size = 4;
    static float decay;
    static void read() { init_from_configuration(decay); }
};
float Memory::decay = 0.5f;

// clang-format off
struct Heard { static uint32_t count; }; uint32_t Heard::count = 0;  // found: Heard::count 4
// clang-format on

template <class T>
T sum(T value) {
    static T total = 0;  // found: total 4
    return total += value;
}

inline uint32_t next() {
    static uint32_t last = 0;  // found: last 4
    POGO_SHARED static uint32_t shared_last;
    static float step = 1.0f;
    init_from_configuration(step);
    shared_last++;
    return last += static_cast<uint32_t>(step);
}

void limits::read() {
    init_from_configuration(low);
    init_from_configuration(inner::level);
}

static void global_setup() {
    init_from_configuration(gain);
    init_from_configuration(limits::high);
    init_from_configuration(unnamed_gain);
    init_float_from_configuration(&weights[1], "weight", 1.0f);
    limits::read();
    Memory::read();
}

extern "C" void user_init(void) {}

extern "C" void user_step(void) {
    static uint16_t const id = pogobot_helper_getid();       // found: id 2
    static std::vector<int> seen(2, rand());                 // found: seen 24
    static int& first = heard.empty() ? seen[0] : heard[0];  // found: first 8
    static int const table[3] = {1, 2, 3};
    POGO_SHARED static std::vector<int> const all(3, rand());
    static thread_local std::vector<int> work;
    auto const count_calls = [] {
        static uint32_t calls;  // found: calls 4
        return ++calls;
    };
    mydata->steps += count_calls() + next() + sum<uint32_t>(2) + Memory::size + limit;
    heard.push_back(id + first + table[rand() % 3] + all[0] + primes[0]);
    work.push_back(static_cast<int>(++unnamed_counter));
    Heard::count += ++Memory::inline_count + ++inline_counter + ++inline_total + ++scratch;
    limits::gain += gain + limits::low + limits::high + unnamed_gain + weights[0] + Memory::decay;
    limits::inner::peak = static_cast<uint8_t>(limits::inner::peak + limits::inner::level);
    if (Heard::count == 12345) {
        std::cout << seen[0];
    }
}

int main() {
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}

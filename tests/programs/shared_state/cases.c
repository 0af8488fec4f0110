// Every kind of variable of a C program.
#include "cases.h"

REGISTER_USERDATA(USERDATA)

#define PARAMETER(variable) init_from_configuration(variable)

// Variables that a robot changes.
uint32_t counter;                               // found: counter 4
static uint8_t started = 3;                     // found: started 1
static float history[8];                        // found: history 32
static limits_t seen = {1.0f, 2.0f};            // found: seen 8
static char const* phase = "start";             // found: phase 8
static void (*action)(void);                    // found: action 8
static struct { uint32_t sum; } statistics;     // found: statistics 4
uint32_t table[2][3] = {{1, 2, 3}, {4, 5, 6}};  // found: table 24
char const* messages[2] = {"one", "two"};       // found: messages 16
volatile uint16_t watched;                      // found: watched 2
uint32_t never_written = 5;                     // found: never_written 4

// Constants.
uint32_t const fixed = 7;
static limits_t const fixed_limits = {3.0f, 4.0f};
static char const* const names[2] = {"alpha", "beta"};
static void (*const actions[1])(void) = {read_elsewhere};
char const text[] = "text";

// Read from the configuration.
float gain = 1.0f;
static bool enabled = true;
static uint16_t duration_ms = 100;
static float weights[3];
static float tap[2] = {0.1f, 0.2f};
static char title[8] = "none";
limits_t limits;
static struct {
    limits_t inner[2];
    int8_t level;
} nested;
static double ratio;
limits_t limits_of_both_files;
static float behind_pointer;              // found: behind_pointer 4
static float* pointer = &behind_pointer;  // found: pointer 8
static int32_t index_of_tap;              // found: index_of_tap 4
static float shadowed;                    // found: shadowed 4
static float same_name = 1.0f;            // found: same_name 4
static float in_macro = 1.0f;

// Shared on purpose, or one for each thread.
POGO_SHARED uint32_t total;
POGO_SHARED static char const* shared_names[2];
POGO_SHARED static uint8_t const shared_constant = 2;
__thread uint32_t scratch;
static _Thread_local uint8_t buffer[4];

static void read_parameter(float* variable, char const* name) {
    init_float_from_configuration(variable, name, *variable);
}

static void global_setup(void) {
    float shadowed = 0.0f;
    init_from_configuration(gain);
    init_from_configuration(enabled);
    init_uint16_from_configuration(&duration_ms, "duration", 200);
    init_array_from_configuration(weights);
    init_float_from_configuration(&tap[index_of_tap], "tap", (tap[1]));
    init_string_from_configuration(title, "title", sizeof(title));
    init_from_configuration(limits.low);
    init_from_configuration((nested.inner[1].high));
    init_from_configuration(nested.level);
    init_double_from_configuration((double*)&ratio, "a \"gain\"", 1.0);
    init_float_from_configuration(pointer, "behind_pointer", 1.0f);
    init_from_configuration(shadowed);
    PARAMETER(in_macro);
    read_parameter(&same_name, "same_name");
    read_elsewhere();
    printf("%d", shadowed > 0.0f);
}

void user_init(void) {
    action = global_setup;
    phase = names[rand() % 2];
}

static uint32_t count_calls(void) {
    static uint32_t calls;  // found: calls 4
    static uint8_t const steps[2] = {1, 2};
    static bool warned = false;  // found: warned 1
    static float factor = 1.0f;
    POGO_SHARED static uint32_t all_calls;
    init_from_configuration(factor);
    if (!warned && rand() % 2) {
        warned = true;
        puts(messages[calls % 2]);
    }
    return (calls += steps[rand() % 2]) + all_calls++ + (uint32_t)factor;
}

void user_step(void) {
    mydata->steps++;
    counter += fixed + never_written;
    history[counter % 8] += 1.0f;
    seen.low += fixed_limits.high + limits.low + tap[0] + weights[counter % 3] + nested.inner[0].low + shadowed;
    statistics.sum += count_calls() + count_in_header() + count_elsewhere();
    table[0][counter % 3]++;
    watched++;
    total++;
    scratch++;
    buffer[counter % 4]++;
    shared_names[counter % 2] = text;
    started = (uint8_t)(started * shared_constant);
    index_of_tap = (int32_t)counter % 2;
    shadowed += gain + same_name + in_macro + (float)ratio + (enabled ? 1.0f : 0.0f) + (float)duration_ms;
    pointer = counter % 2 ? &behind_pointer : &shadowed;
    if (statistics.sum == 12345 && action) {
        action();
        actions[0]();
        printf("%s %s %s %d %d %d %f %f", phase, shared_names[0], title, buffer[0], nested.level, started,
               (double)behind_pointer, (double)seen.low);
    }
}

int main(void) {
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    return 0;
}

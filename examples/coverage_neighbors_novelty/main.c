// Coverage by novelty: robots spread over the arena because they are curious.
//
// After the example of the article on Pogosim. Random searches with heavy-tailed runs: G. M. Viswanathan et al.,
// "Optimizing the success of random searches", Nature 401, 1999. Searching for what is new instead of for a goal:
// J. Lehman, K. O. Stanley, "Abandoning objectives", Evolutionary Computation 19, 2011.
//
// Shows: a random walk that adapts to the neighbours, a table of neighbours with ages, a text as a parameter, a program
// in several files.
//
// A robot runs and tumbles, and knows only which robots are near. Two feelings rise in it and fade away again:
//
//     isolation  while it hears one robot or none,
//     boredom    while it has known nearly all of those it hears for a while.
//
// Their weighted sum is its urge to move on, the "surprise": a content robot hardly moves, a restless one runs fast.
// When the urge exceeds a threshold after a tumble, the robot escapes: the longest run possible, away from here. Each
// escape calms it and raises the threshold, which then falls slowly.
//
// Head LED: colour by number of neighbours. LED 1: green in a run, orange in a tumble.
//
//     ./examples/coverage_neighbors_novelty/coverage_neighbors_novelty -c conf/coverage_neighbors_novelty.yaml
//
// neighbors.h: robots nearby; encounters.h: robots met before; run_law.h: durations of runs.
#include "pogobase.h"

#include <math.h>

#include "encounters.h"
#include "neighbors.h"
#include "run_law.h"

#define MIN_SURPRISE_MIN 0.5f  // the threshold does not fall below

// Numbers as in the data file.
typedef enum { RUN, TUMBLE } state_t;

typedef struct {
    state_t state;
    uint32_t state_start_ms;
    uint32_t state_duration_ms;
    uint8_t forward_dir[3];  // calibration of this robot: direction bits [right, left, back] that drive it forward

    uint32_t heartbeat_ms;  // last time it told its id
    neighbors_t neighbors;
    encounters_t encounters;

    float iso_cnt;       // isolation, s
    float nov_cnt;       // boredom, s
    float surprise_min;  // threshold of an escape
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float loop_dt = 0.025f;           // s: duration of a tick
float heartbeat_hz = 10.0f;       // messages per second, at most
uint32_t max_age = 1500;          // ms: a robot not heard for longer is no neighbour any more
uint32_t run_duration_min = 600;  // ms
uint32_t run_duration_max = 6000;
uint32_t tumble_duration_min = 200;
uint32_t tumble_duration_max = 600;
char run_law[16] = "levy";  // or exponential, linear
float levy_alpha_g = 1.5f;  // exponent of the law of Pareto
float max_speed_frac = 0.5f;
bool enable_backward_dir = true;
float p_backward = 0.05f;  // share of the runs that go backwards

uint8_t iso_min_ids = 1;          // isolated with this many neighbours or fewer
float repeat_frac_thres = 0.85f;  // bored when more than this share of the neighbours is known
float decay_tau = 5.0f;           // s: time constant of both feelings, and until a robot that was met is known
float w_iso = 0.7f;               // weights in the surprise
float w_nov = 0.7f;
float encounter_graph_scale = 1.0f;  // s of a feeling that make one unit of surprise
float urgency_gain = 1.0f;           // share of the speed that depends on the surprise
float surprise_min_0 = 3.0f;         // threshold of an escape at first
bool use_adaptive_surprise_min = true;
float d_surprise_up = 0.3f;     // rise of the threshold at an escape
float d_surprise_down = 0.02f;  // fall per second

POGO_SHARED run_law_t law = RUN_LEVY;  // run_law, parsed

// ---- Feelings ----

static float surprise(void) {
    return (w_iso * mydata->iso_cnt + w_nov * mydata->nov_cnt) / encounter_graph_scale;
}

static bool neighbors_are_known(uint32_t now_ms) {
    neighbors_t const* const neighbors = &mydata->neighbors;
    uint32_t const age_ms = (uint32_t)(1000.0f * decay_tau);
    uint8_t nb_known = 0;
    for (uint8_t i = 0; i < neighbors->nb; i++) {
        if (encounters_is_old(&mydata->encounters, neighbors->list[i].id, now_ms, age_ms)) {
            nb_known++;
        }
    }
    return neighbors->nb > 0 && nb_known > repeat_frac_thres * neighbors->nb;
}

static void feel(uint32_t now_ms) {
    if (mydata->neighbors.nb <= iso_min_ids) {
        mydata->iso_cnt += loop_dt;
    }
    if (neighbors_are_known(now_ms)) {
        mydata->nov_cnt += loop_dt;
    }
    float const fading = 1.0f - loop_dt / decay_tau;
    mydata->iso_cnt *= fading;
    mydata->nov_cnt *= fading;
    if (use_adaptive_surprise_min) {
        mydata->surprise_min = fmaxf(MIN_SURPRISE_MIN, mydata->surprise_min - d_surprise_down * loop_dt);
    }
}

static void calm_down(void) {
    mydata->iso_cnt = fmaxf(0.0f, mydata->iso_cnt - encounter_graph_scale);
    mydata->nov_cnt = fmaxf(0.0f, mydata->nov_cnt - encounter_graph_scale);
    if (use_adaptive_surprise_min) {
        mydata->surprise_min += d_surprise_up;
    }
}

// ---- Motion ----

static void start_state(state_t state, uint32_t now_ms, uint32_t duration_ms) {
    mydata->state = state;
    mydata->state_start_ms = now_ms;
    mydata->state_duration_ms = duration_ms;
}

// Both direction bits as calibrated, or both inverted.
static void set_direction(bool forward) {
    uint8_t const flip = forward ? 0 : 1;
    pogobot_motor_dir_set(motorR, mydata->forward_dir[0] ^ flip);
    pogobot_motor_dir_set(motorL, mydata->forward_dir[1] ^ flip);
}

static void drive(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

// Share of the highest speed, 0 to 1: the more urgent, the faster.
static float urgency(void) {
    float const urge = fminf(1.0f, fmaxf(0.0f, surprise() / (mydata->surprise_min + 1.0f)));
    return 1.0f - urgency_gain + urgency_gain * urge;
}

static void start_run(uint32_t now_ms) {
    // What moves it now decides on the speed, whether or not the escape calms it.
    float const speed = fminf(1.0f, fmaxf(0.0f, urgency()));
    uint32_t duration = run_duration_max;
    if (fabsf(surprise()) >= mydata->surprise_min) {
        calm_down();
    } else {
        // A slower run takes longer.
        duration = random_run_duration(law, run_duration_min, run_duration_max, levy_alpha_g);
        bool const fits = (float)duration < speed * (float)run_duration_max;
        duration = fits ? (uint32_t)((float)duration / speed) : run_duration_max;
    }
    start_state(RUN, now_ms, duration);
    pogobot_led_setColors(0, 255, 0, 1);
    set_direction(!(enable_backward_dir && random_unit() <= p_backward));
    uint16_t const power = (uint16_t)(max_speed_frac * speed * (float)motorFull);
    drive(power, power);
}

static void start_tumble(uint32_t now_ms) {
    uint32_t const range = tumble_duration_max > tumble_duration_min ? tumble_duration_max - tumble_duration_min : 0;
    start_state(TUMBLE, now_ms, tumble_duration_min + (uint32_t)rand() % (range + 1));
    pogobot_led_setColors(255, 160, 0, 1);
    set_direction(true);
    bool const to_left = rand() % 2 == 0;
    drive(to_left ? motorStop : motorFull, to_left ? motorFull : motorStop);
}

// ---- Messages ----

static bool send_heartbeat(void) {
    uint32_t const now_ms = current_time_milliseconds();
    if ((float)(now_ms - mydata->heartbeat_ms) * heartbeat_hz < 1000.0f) {
        return false;
    }
    mydata->heartbeat_ms = now_ms;
    uint16_t id = pogobot_helper_getid();
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&id, sizeof(id)) == 0;
}

static void process_message(message_t* message) {
    uint16_t id;
    if (message->header.payload_length < sizeof(id)) {
        return;
    }
    memcpy(&id, message->payload, sizeof(id));
    if (id != pogobot_helper_getid()) {
        uint32_t const now_ms = current_time_milliseconds();
        neighbors_hear(&mydata->neighbors, id, now_ms);
        encounters_meet(&mydata->encounters, id, now_ms);
    }
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = (uint8_t)(1.0f / loop_dt + 0.5f);
    max_nb_processed_msg_per_tick = 100;
    percent_msgs_sent_per_ticks = 50;
    msg_rx_fn = process_message;
    msg_tx_fn = send_heartbeat;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    mydata->surprise_min = surprise_min_0;
    start_tumble(current_time_milliseconds());
}

void user_step(void) {
    uint32_t const now_ms = current_time_milliseconds();
    neighbors_forget_old(&mydata->neighbors, now_ms, max_age);
    feel(now_ms);
    if (now_ms - mydata->state_start_ms >= mydata->state_duration_ms) {
        if (mydata->state == RUN) {
            start_tumble(now_ms);
        } else {
            start_run(now_ms);
        }
    }
    uint8_t r, g, b;
    qualitative_colormap(mydata->neighbors.nb < 9 ? mydata->neighbors.nb : 9, &r, &g, &b);
    pogobot_led_setColor(r, g, b);
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

static void global_setup(void) {
    init_from_configuration(loop_dt);
    check_parameter(loop_dt, 0.004, 1);
    init_from_configuration(heartbeat_hz);
    check_parameter(heartbeat_hz, 0, 1000);
    init_from_configuration(max_age);
    check_parameter(max_age, 0, MAX_DURATION_MS);
    init_from_configuration(run_duration_min);
    check_parameter(run_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(run_duration_max);
    check_parameter(run_duration_max, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_min);
    check_parameter(tumble_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_max);
    check_parameter(tumble_duration_max, 0, MAX_DURATION_MS);
    init_string_from_configuration(run_law, "run_law", sizeof(run_law));
    init_from_configuration(levy_alpha_g);
    check_parameter(levy_alpha_g, 0.01, 100);
    init_from_configuration(max_speed_frac);
    check_parameter(max_speed_frac, 0, 1);
    init_from_configuration(enable_backward_dir);
    init_from_configuration(p_backward);
    check_parameter(p_backward, 0, 1);
    init_from_configuration(iso_min_ids);
    init_from_configuration(repeat_frac_thres);
    check_parameter(repeat_frac_thres, 0, 1);
    init_from_configuration(decay_tau);
    check_parameter(decay_tau, loop_dt, 1e6);
    init_from_configuration(w_iso);
    check_parameter(w_iso, -1e6, 1e6);
    init_from_configuration(w_nov);
    check_parameter(w_nov, -1e6, 1e6);
    init_from_configuration(encounter_graph_scale);
    check_parameter(encounter_graph_scale, 1e-3, 1e6);
    init_from_configuration(urgency_gain);
    check_parameter(urgency_gain, 0, 1);
    init_from_configuration(surprise_min_0);
    check_parameter(surprise_min_0, 0, 1e6);
    init_from_configuration(use_adaptive_surprise_min);
    init_from_configuration(d_surprise_up);
    check_parameter(d_surprise_up, 0, 1e6);
    init_from_configuration(d_surprise_down);
    check_parameter(d_surprise_down, 0, 1e6);
    if (!run_law_of_name(run_law, &law)) {
        refuse_parameter("run_law", "levy, exponential or linear");
    }
}

static void create_data_schema(void) {
    data_add_column_int8("total_neighbors");
    data_add_column_int8("nov_unique");
    data_add_column_double("iso_cnt");
    data_add_column_double("nov_cnt");
    data_add_column_double("surprise");
    data_add_column_int8("state");
    data_add_column_string("neighbors_list");
}

static void export_data(void) {
    char list[MAX_NEIGHBORS * sizeof("65535,")] = "";
    size_t length = 0;
    for (uint8_t i = 0; i < mydata->neighbors.nb; i++) {
        char const* const format = i == 0 ? "%u" : ",%u";
        length += (size_t)snprintf(list + length, sizeof(list) - length, format, mydata->neighbors.list[i].id);
    }
    uint8_t const nb_met = mydata->encounters.nb;
    data_set_value_int8("total_neighbors", mydata->neighbors.nb);
    data_set_value_int8("nov_unique", nb_met < INT8_MAX ? nb_met : INT8_MAX);
    data_set_value_double("iso_cnt", (double)mydata->iso_cnt);
    data_set_value_double("nov_cnt", (double)mydata->nov_cnt);
    data_set_value_double("surprise", (double)surprise());
    data_set_value_int8("state", mydata->state);
    data_set_value_string("neighbors_list", list);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}

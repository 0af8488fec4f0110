// Moving oscillators: robots that wander around and fall into step (Y. Kuramoto, 1975; J. A. Acebron et al., "The
// Kuramoto model: a simple paradigm for synchronization phenomena", Reviews of Modern Physics 77, 2005).
//
// Shows: a differential equation in real time, motion and inner state that act on each other, a text parameter, ending
// a run from the program.
//
// Each robot is a clock with phase theta and its own frequency w. It is pulled towards the n neighbours it hears:
//
//     d theta / dt = w + K / n * sum over neighbours of sin(theta_j - theta) + g_m * (1 in a run, -1 in a tumble)
//
// Meanwhile it runs and tumbles, with tumbles longer and runs shorter while sin(theta) is positive. As they meet ever
// new neighbours, the robots agree on one rhythm. The order parameter R = |mean of exp(i theta)| measures how well,
// from 0 (no order) to 1 (all in phase). The run ends when R and the share of the robots in one half of
// the dial both exceed 0.95.
//
//     ./examples/moving_oscillators/moving_oscillators -c conf/moving_oscillators.yaml
#include <math.h>

#include "pogobase.h"

#define PI 3.14159265f
#define MAX_NEIGHBORS 20
#define MAX_AGE_MS 200
#define PHASE_UNITS (32767.0f / PI)  // of the messages: pi is 32767
#define LONGEST_PERIOD_S 8.0f        // end of the colour scale
#define IN_STEP 0.95                 // ends the run

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    int16_t phase;
} message_content_t;

typedef struct {
    uint16_t id;
    float theta;
    uint32_t heard_ms;
} neighbor_t;

typedef enum { PHASE_RUN, PHASE_TUMBLE } phase_t;

typedef struct {
    float theta;  // rad, -pi to pi
    float natural_frequency;
    time_reference_t last_tick;
    float turn_s;    // since theta last passed pi
    float period_s;  // smoothed time of a turn
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;

    phase_t phase;
    uint32_t phase_start_ms;
    uint32_t phase_duration_ms;
    uint8_t forward_dir[3];  // calibration of this robot: direction bits [right, left, back] that drive it forward
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float natural_freq_mean = 1.0f;          // rad/s
float natural_freq_std = 0.1f;           // rad/s, largest difference from the mean
float coupling_k = 1.0f;                 // rad/s
float move_to_osc_gain = 0.25f;          // rad/s
float osc_to_move_gain = 0.25f;          // largest relative change of a duration
bool enable_locomotion_coupling = true;  // whether the phase acts on durations
float max_speed_frac = 0.4f;             // of full power
uint32_t run_duration_min = 800;         // ms
uint32_t run_duration_max = 4000;        // ms
uint32_t tumble_duration_min = 200;      // ms
uint32_t tumble_duration_max = 600;      // ms
char led_mode[8] = "sign";               // sign, phase or period

// ---- Oscillator ----

static float wrapped(float angle) {
    return angle > PI ? angle - 2.0f * PI : angle < -PI ? angle + 2.0f * PI : angle;
}

static float random_between(float low, float high) {
    return low + (high - low) * ((float)rand() / (float)RAND_MAX);
}

static void forget_silent_neighbors(void) {
    uint8_t kept = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (current_time_milliseconds() - mydata->neighbors[i].heard_ms <= MAX_AGE_MS) {
            mydata->neighbors[kept++] = mydata->neighbors[i];
        }
    }
    mydata->nb_neighbors = kept;
}

static void advance_oscillator(void) {
    float const dt_s = (float)pogobot_stopwatch_lap(&mydata->last_tick) * 1e-6f;
    float speed = mydata->natural_frequency + (mydata->phase == PHASE_RUN ? move_to_osc_gain : -move_to_osc_gain);
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        speed += coupling_k / (float)mydata->nb_neighbors * sinf(mydata->neighbors[i].theta - mydata->theta);
    }
    mydata->turn_s += dt_s;
    mydata->theta += speed * dt_s;
    if (mydata->theta > PI) {
        mydata->period_s += 0.3f * (mydata->turn_s - mydata->period_s);
        mydata->turn_s = 0.0f;
    }
    mydata->theta = wrapped(mydata->theta);
}

// ---- Motion ----

static float random_duration(uint32_t min_ms, uint32_t max_ms, float gain) {
    float factor = enable_locomotion_coupling ? 1.0f + gain * sinf(mydata->theta) : 1.0f;
    factor = factor < 0.5f ? 0.5f : factor > 1.5f ? 1.5f : factor;
    return factor * random_between((float)min_ms, (float)max_ms);
}

static void start_phase(phase_t phase) {
    uint16_t const power = (uint16_t)(max_speed_frac * motorFull);
    uint8_t flip = 0;
    uint16_t left = power, right = power;
    if (phase == PHASE_RUN) {
        mydata->phase_duration_ms = (uint32_t)random_duration(run_duration_min, run_duration_max, -osc_to_move_gain);
        flip = (uint8_t)(rand() % 2);  // forwards or backwards
        pogobot_led_setColors(0, 25, 0, 1);
    } else {
        mydata->phase_duration_ms =
            (uint32_t)random_duration(tumble_duration_min, tumble_duration_max, osc_to_move_gain);
        *(rand() % 2 == 0 ? &left : &right) = motorStop;
        pogobot_led_setColors(25, 16, 0, 1);
    }
    mydata->phase = phase;
    mydata->phase_start_ms = current_time_milliseconds();
    pogobot_motor_dir_set(motorR, mydata->forward_dir[0] ^ flip);
    pogobot_motor_dir_set(motorL, mydata->forward_dir[1] ^ flip);
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

// ---- Messages ----

static bool send_phase(void) {
    message_content_t message = {.sender_id = pogobot_helper_getid(), .phase = (int16_t)(mydata->theta * PHASE_UNITS)};
    return pogobot_infrared_sendShortMessage_omni((uint8_t*)&message, sizeof(message)) == 0;
}

static void process_message(message_t* received) {
    message_content_t message;
    if (received->header.payload_length < sizeof(message)) {
        return;
    }
    memcpy(&message, received->payload, sizeof(message));
    uint8_t place = 0;
    while (place < mydata->nb_neighbors && mydata->neighbors[place].id != message.sender_id) {
        place++;
    }
    if (place == MAX_NEIGHBORS) {
        return;
    }
    mydata->nb_neighbors += place == mydata->nb_neighbors;
    mydata->neighbors[place] = (neighbor_t){
        .id = message.sender_id, .theta = (float)message.phase / PHASE_UNITS, .heard_ms = current_time_milliseconds()};
}

static void show_state(void) {
    uint8_t r = 0, g = 0, b = 0;
    if (strcmp(led_mode, "phase") == 0) {
        rainbow_colormap((uint8_t)((mydata->theta + PI) / (2.0f * PI) * 255.0f), &r, &g, &b);
    } else if (strcmp(led_mode, "period") == 0) {
        float const share = mydata->period_s / LONGEST_PERIOD_S;
        rainbow_colormap((uint8_t)((share < 1.0f ? share : 1.0f) * 255.0f), &r, &g, &b);
    } else {
        *(mydata->theta >= 0.0f ? &r : &b) = 25;
    }
    pogobot_led_setColor(r, g, b);
}

// ---- The end of the run ----

#ifdef SIMULATOR
// Shared by all robots on purpose: what an observer of the whole swarm sees.
POGO_SHARED static int nb_in_upper_half;
POGO_SHARED static double sum_cos, sum_sin;

// Counts this robot as `sign` robots.
static void count(int sign) {
    nb_in_upper_half += mydata->theta >= 0.0f ? sign : 0;
    sum_cos += sign * (double)cosf(mydata->theta);
    sum_sin += sign * (double)sinf(mydata->theta);
}

// Called 60 times a second, not for a robot.
static void global_step(void) {
    double const nb = get_nb_robots();
    double const order = sqrt(sum_cos * sum_cos + sum_sin * sum_sin) / nb;
    if (nb_in_upper_half > IN_STEP * nb && order > IN_STEP) {
        stop_simulation();
    }
}
#else
static void count(int sign) {
    (void)sign;  // no robot sees the whole swarm
}
#endif

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 30;
    max_nb_processed_msg_per_tick = NUMEL;  // all that the queue holds
    percent_msgs_sent_per_ticks = 100;      // every 33 ms
    msg_rx_fn = process_message;
    msg_tx_fn = send_phase;
    pogobot_motor_dir_mem_get(mydata->forward_dir);
    pogobot_stopwatch_reset(&mydata->last_tick);
    mydata->theta = random_between(-PI, PI);
    mydata->natural_frequency =
        random_between(natural_freq_mean - natural_freq_std, natural_freq_mean + natural_freq_std);
    start_phase(rand() % 2 == 0 ? PHASE_RUN : PHASE_TUMBLE);
    count(+1);
}

void user_step(void) {
    forget_silent_neighbors();
    count(-1);
    advance_oscillator();
    count(+1);
    if (current_time_milliseconds() - mydata->phase_start_ms >= mydata->phase_duration_ms) {
        start_phase(mydata->phase == PHASE_RUN ? PHASE_TUMBLE : PHASE_RUN);
    }
    show_state();
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours
#define MAX_FREQUENCY 20          // rad/s; the sum of all of them stays below half a turn in a tick

static void global_setup(void) {
    init_from_configuration(natural_freq_mean);
    check_parameter(natural_freq_mean, -MAX_FREQUENCY, MAX_FREQUENCY);
    init_from_configuration(natural_freq_std);
    check_parameter(natural_freq_std, 0, MAX_FREQUENCY);
    init_from_configuration(coupling_k);
    check_parameter(coupling_k, -MAX_FREQUENCY, MAX_FREQUENCY);
    init_from_configuration(move_to_osc_gain);
    check_parameter(move_to_osc_gain, -MAX_FREQUENCY, MAX_FREQUENCY);
    init_from_configuration(osc_to_move_gain);
    check_parameter(osc_to_move_gain, -1, 1);
    init_from_configuration(enable_locomotion_coupling);
    init_from_configuration(max_speed_frac);
    check_parameter(max_speed_frac, 0, 1);
    init_from_configuration(run_duration_min);
    check_parameter(run_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(run_duration_max);
    check_parameter(run_duration_max, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_min);
    check_parameter(tumble_duration_min, 0, MAX_DURATION_MS);
    init_from_configuration(tumble_duration_max);
    check_parameter(tumble_duration_max, 0, MAX_DURATION_MS);
    init_array_from_configuration(led_mode);
    if (strcmp(led_mode, "sign") != 0 && strcmp(led_mode, "phase") != 0 && strcmp(led_mode, "period") != 0) {
        refuse_parameter("led_mode", "sign, phase or period");
    }
}

static void create_data_schema(void) {
    data_add_column_double("theta");
    data_add_column_int8("nb_neighbors");
}

static void export_data(void) {
    data_set_value_double("theta", mydata->theta);
    data_set_value_int8("nb_neighbors", mydata->nb_neighbors);
}
#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    SET_CALLBACK(callback_global_step, global_step);
    return 0;
}

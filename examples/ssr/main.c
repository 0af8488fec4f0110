// Spectral swarm robotics: the robots of a swarm hear the shape of the arena they are in.
//
// L. Cazenille, N. Lobato-Dauzier, A. Loi, M. Ito, O. Marchal, N. Aubert-Kato, N. Bredeche, A. J. Genot, "Hearing the
// shape of an arena with spectral swarm robotics", arXiv:2403.17147, 2024. The article on Pogosim shows a run, too.
//
// Shows: a schedule of several behaviours, a program in several files, estimating a number by message passing only.
//
// Robots and the links between them are a graph. It has the shape of the arena, since robots fill the arena evenly. If
// each robot has a number s and moves it towards those of its neighbours, s_i += sum_j (s_j - s_i) / k, the differences
// die out: fast ones between neighbours first, at last only one pattern is left, positive in one half of the arena and
// negative in the other one. It fades as exp(-lambda t), t = steps / k, where lambda is the second eigenvalue of the
// graph's Laplacian, the slowest time scale of diffusion in that shape. It is smaller in an annulus than in a disk of
// the same area, where the path from one end to the other is shorter. Each robot measures lambda on its own number.
//
// All durations are in unit periods (`unit_period`), one step of a diffusion. A flash of light starts all robots:
//
//     random walk (20), then repeatedly:
//     wait (1)             LEDs as they were
//     random walk (20)     another graph of the same arena
//     pre-diffusion (100)  from random numbers; the end is the mean of them, or close to it
//     diffusion (100)      from the same random numbers without that mean; lambda is fitted
//     averaging (20)       the robots agree on a lambda
//     averaging (20)       the robots agree on the mean lambda of all iterations, and on the shape
//
// Head LED: red and blue are the signs of s in a diffusion; afterwards the shape, cyan a disk, violet an annulus. LED 1
// keeps the shape.
//
//     ./examples/ssr/ssr -c conf/ssr.yaml
//     ./examples/ssr/ssr -c conf/ssr.yaml --set arena_file=arenas/annulus.csv
//
// Three diffusions run at the same time (neighbors.h); line_fit.h and decay.h fit lambda.
#include "pogobase.h"

#include <math.h>

#include "decay.h"
#include "neighbors.h"

#define FLASH_RISE 40     // rise of a photosensor within one tick that starts the experiment
#define WALK_CHOICE 5     // unit periods between two choices of a random walk
#define WALK_CHANCE 30    // it drives ahead, to the left or to the right with a chance of one in this many each
#define MIN_CHANGE 1e-3f  // a smaller sum of differences says that a diffusion has ended
#define MIN_S 1e-7f       // as does a smaller |s|, whose logarithm is noise

// Numbers as in the data file.
typedef enum { INIT, INIT_WALK, WALK, PRE_DIFFUSION, DIFFUSION, AVG_LAMBDA, AVG_AVG_LAMBDA, WAITING } behavior_t;

enum { MSG_NONE = 5, MSG_PRE_S, MSG_S, MSG_LAMBDA, MSG_AVG_LAMBDA };

typedef struct __attribute__((__packed__)) {
    int32_t type;
    float val[NB_DIFFUSIONS];
} ssr_message_t;

typedef struct {
    float s;
    float s_initial;  // the random number at the beginning of pre-diffusion
    float change;     // sum of the differences to the neighbours in the last step
    bool ended;       // there is nothing more to learn from it
    decay_t decay;
} diffusion_t;

// A number that robots agree on; not all have one of their own.
typedef struct {
    bool known;
    float value;
} estimate_t;

typedef struct {
    behavior_t behavior;
    uint32_t start_ms;  // of the behaviour
    uint16_t periods;   // unit periods of it that have passed
    int16_t light[3];   // photosensors at the last tick

    neighbors_t neighbors;  // heard in this period
    uint8_t nb_neighbors;   // in the last one
    uint16_t neighbor_ids[MAX_NEIGHBORS];

    diffusion_t diffusion[NB_DIFFUSIONS];
    bool diverged;  // some |s| became impossibly large in this iteration
    estimate_t lambda;
    float sum_lambda;  // of the iterations that had one
    uint16_t nb_lambda;
    estimate_t avg_lambda;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint32_t unit_period = 2500;           // ms; long enough to hear each neighbour at least once
uint16_t nb_diffusion_steps = 100;     // of pre-diffusion, and of diffusion
uint16_t nb_burn_in_steps = 20;        // of diffusion, before which the fit of lambda does not look
float initial_s_max_val = 1.0f;        // s is this or minus this at first
float inv_tau = 20.0f;                 // k: steps per unit of time; must be larger than the number of neighbours
uint16_t diffusion_min_nb_points = 3;  // for a fit to count; the window of decay.h must be full anyway
float diffusion_min_abs_s = 0.0f;      // below, a diffusion has ended
// A robot has no lambda of its own in an iteration when its |s| is larger at the end of the first diffusion. 0: no
// limit.
float diffusion_convergence_threshold = 0.1f;

// Mean lambda of each class: the shape is that of the nearest one. See conf/ssr.yaml.
#define NB_CLASSES 4
float class_centroids[NB_CLASSES] = {0.0001f, 0.01f, 0.4034f, 0.6577f};
static uint8_t const class_colors[NB_CLASSES][3] = {
    {0, 3, 0},  // the graph falls into pieces
    {2, 0, 2},  // an annulus that robots have cut open
    {2, 0, 2},  // an annulus
    {0, 2, 2},  // a disk
};

// ---- LEDs, motors, light ----

static uint8_t class_of(estimate_t lambda) {
    uint8_t nearest = 0;
    for (uint8_t i = 1; i < NB_CLASSES && lambda.known; i++) {
        if (fabsf(fabsf(lambda.value) - class_centroids[i]) < fabsf(fabsf(lambda.value) - class_centroids[nearest])) {
            nearest = i;
        }
    }
    return nearest;
}

static void show_class(uint8_t led) {
    uint8_t const* const color = class_colors[class_of(mydata->avg_lambda)];
    pogobot_led_setColors(color[0], color[1], color[2], led);
}

static void show_sign(void) {
    if (mydata->diffusion[0].s > 0.0f) {
        pogobot_led_setColor(3, 0, 0);
    } else {
        pogobot_led_setColor(0, 0, 2);
    }
}

static void drive(uint16_t left, uint16_t right) {
    pogobot_motor_set(motorL, left);
    pogobot_motor_set(motorR, right);
}

// Mostly none: the graph changes a little, the robots stay spread out.
static void choose_move(void) {
    int const choice = rand() % WALK_CHANCE;
    drive(choice == 0 || choice == 2 ? motorFull : motorStop, choice == 0 || choice == 1 ? motorFull : motorStop);
}

// True when the light has risen on any sensor since the last call.
static bool flash_seen(void) {
    bool seen = false;
    for (uint8_t sensor = 0; sensor < 3; sensor++) {
        int16_t const light = pogobot_photosensors_read(sensor);
        seen = seen || light - mydata->light[sensor] >= FLASH_RISE;
        mydata->light[sensor] = light;
    }
    return seen;
}

// ---- Messages ----

static int32_t message_type(void) {
    switch (mydata->behavior) {
        case PRE_DIFFUSION:
            return MSG_PRE_S;
        case DIFFUSION:
            return MSG_S;
        case AVG_LAMBDA:
            return mydata->lambda.known ? MSG_LAMBDA : MSG_NONE;
        case AVG_AVG_LAMBDA:
            return mydata->avg_lambda.known ? MSG_AVG_LAMBDA : MSG_NONE;
        default:
            return MSG_NONE;
    }
}

static bool send_message(void) {
    ssr_message_t message = {.type = message_type()};
    switch (message.type) {
        case MSG_PRE_S:
        case MSG_S:
            for (uint8_t i = 0; i < NB_DIFFUSIONS; i++) {
                message.val[i] = mydata->diffusion[i].s;
            }
            break;
        case MSG_LAMBDA:
            message.val[0] = mydata->lambda.value;
            break;
        case MSG_AVG_LAMBDA:
            message.val[0] = mydata->avg_lambda.value;
            break;
        default:
            return false;
    }
    return pogobot_infrared_sendLongMessage_omniGen((uint8_t*)&message, sizeof(message)) == 0;
}

// The type that belongs to the behaviour; a robot without a lambda listens, too.
static bool expects(int32_t type) {
    switch (mydata->behavior) {
        case PRE_DIFFUSION:
            return type == MSG_PRE_S;
        case DIFFUSION:
            return type == MSG_S;
        case AVG_LAMBDA:
            return type == MSG_LAMBDA;
        case AVG_AVG_LAMBDA:
            return type == MSG_AVG_LAMBDA;
        default:
            return false;
    }
}

static void process_message(message_t* received) {
    if (received->header._packet_type != ir_t_user || received->header.payload_length < sizeof(ssr_message_t) ||
        received->header._sender_id == pogobot_helper_getid()) {
        return;
    }
    ssr_message_t message;
    memcpy(&message, received->payload, sizeof(message));
    if (expects(message.type)) {
        float val[NB_DIFFUSIONS];
        memcpy(val, message.val, sizeof(val));
        neighbors_hear(&mydata->neighbors, received->header._sender_id, val);
    }
}

// ---- Diffusion ----

static void start_pre_diffusion(void) {
    mydata->diverged = false;
    mydata->lambda.known = false;
    for (uint8_t i = 0; i < NB_DIFFUSIONS; i++) {
        diffusion_t* const diffusion = &mydata->diffusion[i];
        memset(diffusion, 0, sizeof(*diffusion));
        diffusion->s_initial = rand() % 2 == 0 ? initial_s_max_val : -initial_s_max_val;
        diffusion->s = diffusion->s_initial;
    }
}

// Without its mean, s goes to 0 everywhere.
static void start_diffusion(void) {
    for (uint8_t i = 0; i < NB_DIFFUSIONS; i++) {
        diffusion_t* const diffusion = &mydata->diffusion[i];
        diffusion->s = diffusion->s_initial - diffusion->s;
    }
}

static void diffuse(void) {
    for (uint8_t i = 0; i < NB_DIFFUSIONS; i++) {
        diffusion_t* const diffusion = &mydata->diffusion[i];
        diffusion->change = neighbors_sum_of_differences(&mydata->neighbors, i, diffusion->s);
        diffusion->s += diffusion->change / inv_tau;
        mydata->diverged = mydata->diverged || fabsf(diffusion->s) > 2.0f * initial_s_max_val;
    }
}

static void collect_points(void) {
    for (uint8_t i = 0; i < NB_DIFFUSIONS; i++) {
        diffusion_t* const diffusion = &mydata->diffusion[i];
        float const size = fabsf(diffusion->s);
        if (fabsf(diffusion->change) <= MIN_CHANGE || size <= MIN_S || size <= diffusion_min_abs_s) {
            diffusion->ended = true;
        }
        if (!diffusion->ended && mydata->periods >= nb_burn_in_steps) {
            decay_add(&diffusion->decay, (float)mydata->periods / inv_tau, diffusion->s);
        }
    }
}

// The mean over the diffusions, if all of them went well.
static estimate_t own_lambda(void) {
    estimate_t lambda = {.known = !mydata->diverged, .value = 0.0f};
    if (diffusion_convergence_threshold > 0.0f && fabsf(mydata->diffusion[0].s) > diffusion_convergence_threshold) {
        lambda.known = false;
    }
    for (uint8_t i = 0; i < NB_DIFFUSIONS; i++) {
        lambda.known = lambda.known && decay_is_known(&mydata->diffusion[i].decay, diffusion_min_nb_points);
        lambda.value += mydata->diffusion[i].decay.lambda / NB_DIFFUSIONS;
    }
    return lambda;
}

// ---- Averaging ----

// The mean of the own number, if there is one, and those heard.
static void average(estimate_t* estimate) {
    neighbors_t const* const neighbors = &mydata->neighbors;
    if (!estimate->known && neighbors->nb > 0) {
        *estimate = (estimate_t){.known = true, .value = neighbors->list[0].val[0]};
        estimate->value += neighbors_sum_of_differences(neighbors, 0, estimate->value) / neighbors->nb;
    } else if (estimate->known) {
        estimate->value += neighbors_sum_of_differences(neighbors, 0, estimate->value) / (neighbors->nb + 1);
    }
}

static void add_lambda_to_mean(void) {
    if (mydata->lambda.known) {
        mydata->sum_lambda += mydata->lambda.value;
        mydata->nb_lambda++;
    }
    if (mydata->nb_lambda > 0) {
        mydata->avg_lambda = (estimate_t){.known = true, .value = mydata->sum_lambda / mydata->nb_lambda};
    }
}

// ---- Schedule ----

static uint16_t duration_of(behavior_t behavior) {
    switch (behavior) {
        case WAITING:
            return 1;
        case PRE_DIFFUSION:
        case DIFFUSION:
            return nb_diffusion_steps;
        default:
            return 20;
    }
}

static behavior_t next_after(behavior_t behavior) {
    switch (behavior) {
        case WAITING:
            return WALK;
        case WALK:
            return PRE_DIFFUSION;
        case PRE_DIFFUSION:
            return DIFFUSION;
        case DIFFUSION:
            return AVG_LAMBDA;
        case AVG_LAMBDA:
            return AVG_AVG_LAMBDA;
        default:
            return WAITING;
    }
}

static void start(behavior_t behavior, uint32_t now_ms) {
    mydata->behavior = behavior;
    mydata->start_ms = now_ms;
    mydata->periods = 0;
    switch (behavior) {
        case INIT_WALK:
        case WALK:
            choose_move();
            break;
        case PRE_DIFFUSION:
            pogobot_led_setColor(1, 1, 1);
            start_pre_diffusion();
            break;
        case DIFFUSION:
            start_diffusion();
            show_sign();
            break;
        default:
            break;
    }
}

static void finish(behavior_t behavior) {
    switch (behavior) {
        case INIT_WALK:
        case WALK:
            drive(motorStop, motorStop);
            break;
        case DIFFUSION:
            mydata->lambda = own_lambda();
            break;
        case AVG_LAMBDA:
            add_lambda_to_mean();
            show_class(1);
            break;
        case AVG_AVG_LAMBDA:
            show_class(0);
            show_class(1);
            break;
        default:
            break;
    }
}

static void finish_period(void) {
    mydata->periods++;
    switch (mydata->behavior) {
        case INIT_WALK:
        case WALK:
            if (mydata->periods % WALK_CHOICE == 0) {
                choose_move();
            }
            break;
        case PRE_DIFFUSION:
            diffuse();
            break;
        case DIFFUSION:
            diffuse();
            collect_points();
            show_sign();
            break;
        case AVG_LAMBDA:
            average(&mydata->lambda);
            break;
        case AVG_AVG_LAMBDA:
            average(&mydata->avg_lambda);
            break;
        default:
            break;
    }
    mydata->nb_neighbors = mydata->neighbors.nb;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        mydata->neighbor_ids[i] = mydata->neighbors.list[i].id;
    }
    neighbors_forget(&mydata->neighbors);
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = 100;
    percent_msgs_sent_per_ticks = 50;
    msg_rx_fn = process_message;
    msg_tx_fn = send_message;
    flash_seen();  // takes the first readings
}

void user_step(void) {
    uint32_t const now_ms = current_time_milliseconds();
    if (mydata->behavior == INIT) {
        if (flash_seen()) {
            start(INIT_WALK, now_ms);
        }
        return;
    }
    if (now_ms - mydata->start_ms < (mydata->periods + 1) * unit_period) {
        return;
    }
    finish_period();
    uint16_t const duration = duration_of(mydata->behavior);
    if (mydata->periods == duration) {
        finish(mydata->behavior);
        // The time when it was due, not now: so the robots' schedules stay together.
        start(next_after(mydata->behavior), mydata->start_ms + duration * unit_period);
    }
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(unit_period);
    check_parameter(unit_period, 1, 60000);
    init_from_configuration(nb_diffusion_steps);
    check_parameter(nb_diffusion_steps, 1, UINT16_MAX);
    init_from_configuration(nb_burn_in_steps);
    init_from_configuration(initial_s_max_val);
    check_parameter(initial_s_max_val, 1e-3, 1e6);
    init_from_configuration(inv_tau);
    check_parameter(inv_tau, 1, 1e6);
    init_from_configuration(diffusion_min_nb_points);
    init_from_configuration(diffusion_min_abs_s);
    check_parameter(diffusion_min_abs_s, 0, 1e6);
    init_from_configuration(diffusion_convergence_threshold);
    check_parameter(diffusion_convergence_threshold, 0, 1e6);
    init_array_from_configuration(class_centroids);
}

static void create_data_schema(void) {
    data_add_column_int8("current_behavior");
    data_add_column_bool("diffusion_valid1");
    data_add_column_double("t");
    data_add_column_int8("nb_neighbors");
    data_add_column_string("neighbors_list");
    data_add_column_double("s");
    data_add_column_double("lambda");
    data_add_column_double("avg_lambda");
}

static void export_neighbors(void) {
    char list[MAX_NEIGHBORS * sizeof("65535,")] = "";
    size_t length = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        length +=
            (size_t)snprintf(list + length, sizeof(list) - length, i == 0 ? "%u" : ",%u", mydata->neighbor_ids[i]);
    }
    data_set_value_int8("nb_neighbors", mydata->nb_neighbors);
    data_set_value_string("neighbors_list", list);
}

// A robot that has no lambda leaves it empty.
static void export_data(void) {
    diffusion_t const* const first = &mydata->diffusion[0];
    bool const diffuses = mydata->behavior == PRE_DIFFUSION || mydata->behavior == DIFFUSION;
    data_set_value_int8("current_behavior", mydata->behavior);
    data_set_value_bool("diffusion_valid1", decay_is_known(&first->decay, diffusion_min_nb_points));
    data_set_value_double("t", diffuses ? (double)mydata->periods / (double)inv_tau : 0.0);
    export_neighbors();
    data_set_value_double("s", (double)first->s);
    if (mydata->lambda.known) {
        data_set_value_double("lambda", (double)mydata->lambda.value);
    }
    if (mydata->avg_lambda.known) {
        data_set_value_double("avg_lambda", (double)mydata->avg_lambda.value);
    }
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

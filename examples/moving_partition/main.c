// A moving partition: a swarm with one word for a thing is divided, its halves drift apart, and it is joined again.
//
// Shows: a supervisor that moves a body during the run (pogosim/world.h), slowly and without crushing a robot, and that
// measures what no robot can know; events that have no memory; columns of the run.
//
// Robots copy each other's words at random, without preference, and now and then one invents a new word. Each robot
// copies a neighbour once per `copy_period` and invents a word once per `invention_period` on average. This is how
// neutral genes spread (P. A. P. Moran, "Random processes in genetics", Mathematical Proceedings of the Cambridge
// Philosophical Society 54, 1958; M. Kimura, J. F. Crow, Genetics 49, 1964), and dialects. At `divide_time` a partition
// slides in from a recess in the wall, at `rejoin_time` it slides back.
//
// The measure is the share of pairs of robots that have the same word (in genetics, identity by descent). Copying keeps
// it high within each half. Between the halves nothing is copied, so two robots have the same word only if neither of
// their words was replaced by an invention since the division (G. Malecot, "Les mathematiques de l'heredite", 1948):
//
//     same_across(t) = same_across(division) * exp(-2 t / invention_period)
//
// whatever the robots do within their half. Once joined again, one word spreads through both.
//
//     ./examples/moving_partition/moving_partition -c conf/moving_partition.yaml
//
// The head shows the word, the same colour for the same word. In the simulator only robots stop infrared, so the
// partition is thicker than messages reach. With real robots it is moved by hand.
#include <math.h>

#include "pogobase.h"

#define FIRST_WORD 0xFFFFFFFFu  // that all robots know at the start
#define MAX_NEIGHBORS 20
#define MAX_AGE_MS 300  // without a message, after which a neighbour is forgotten
#define TURN_MS 1000    // between two random turns

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    uint32_t word;
} message_content_t;

typedef struct {
    uint16_t id;
    uint32_t word;
    uint32_t heard_ms;
} neighbor_t;

typedef struct {
    uint32_t word;  // id of the robot that invented it, and which of its inventions it is
    uint16_t nb_inventions;
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
    uint32_t next_turn_ms;
    time_reference_t last_tick;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float copy_period = 1.0f;         // s, mean time between two words that a robot copies
float invention_period = 300.0f;  // s, mean time between two words that it invents
float divide_time = 60.0f;        // s
float rejoin_time = 300.0f;       // s
float partition_speed = 40.0f;    // mm/s

// ---- The robots ----

// Whether something that happens once per `period_s` on average happens in the last `dt_s` seconds.
static bool happens(float period_s, float dt_s) {
    return (float)rand() / ((float)RAND_MAX + 1.0f) * period_s < dt_s;
}

static void copy_a_neighbor(void) {
    if (mydata->nb_neighbors > 0) {
        mydata->word = mydata->neighbors[rand() % mydata->nb_neighbors].word;
    }
}

static void invent_a_word(void) {
    mydata->word = (uint32_t)pogobot_helper_getid() << 16 | mydata->nb_inventions++;
}

static void show_word(void) {
    // Multiplied by a large odd number, so that the words of one robot differ in colour, too.
    uint32_t const hash = mydata->word * 2654435761u;
    uint8_t r, g, b;
    rainbow_colormap((uint8_t)(hash >> 24), &r, &g, &b);
    pogobot_led_setColor(r, g, b);
}

// Now and then ahead, to the left or to the right.
static void walk_at_random(void) {
    if (current_time_milliseconds() >= mydata->next_turn_ms) {
        mydata->next_turn_ms += TURN_MS;
        int const way = rand() % 3;
        pogobot_motor_set(motorL, way == 1 ? motorStop : motorFull);
        pogobot_motor_set(motorR, way == 2 ? motorStop : motorFull);
    }
}

static bool send_word(void) {
    message_content_t message = {.sender_id = pogobot_helper_getid(), .word = mydata->word};
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
    mydata->neighbors[place] =
        (neighbor_t){.id = message.sender_id, .word = message.word, .heard_ms = current_time_milliseconds()};
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

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = NUMEL;  // all that the queue holds
    percent_msgs_sent_per_ticks = 30;
    msg_rx_fn = process_message;
    msg_tx_fn = send_word;
    mydata->word = FIRST_WORD;
    pogobot_stopwatch_reset(&mydata->last_tick);
}

void user_step(void) {
    float const dt_s = (float)pogobot_stopwatch_lap(&mydata->last_tick) * 1e-6f;
    forget_silent_neighbors();
    if (happens(copy_period, dt_s)) {
        copy_a_neighbor();
    }
    if (happens(invention_period, dt_s)) {
        invent_a_word();
    }
    show_word();
    walk_at_random();
}

// ---- The supervisor, in the simulator only ----

#ifdef SIMULATOR

// As in conf/moving_partition.yaml; mm.
#define ROBOT_RADIUS 26.5
#define HALF_THICKNESS 35.0  // of the partition
#define HALF_LENGTH 300.0
#define RECESS_Y 300.0        // of its middle, in its recess
#define TRAVEL 600.0          // from its recess into the room
#define NEAR 130.0            // to the wall ahead: two robots and a bit
#define CLEARANCE 2.0         // between it and a robot
#define MEASURING_PERIOD 0.5  // s
#define GLOBAL_STEP 0.016     // s

// Variables of the experiment, not of a robot.
POGO_SHARED static double shut = 0.0;  // way of the partition out of its recess, mm
POGO_SHARED static double next_measurement_s = 0.0;

static void global_setup(void) {
    init_from_configuration(copy_period);
    check_parameter(copy_period, 0.001, 1.0e9);
    init_from_configuration(invention_period);
    check_parameter(invention_period, 0.001, 1.0e9);
    init_from_configuration(divide_time);
    check_parameter(divide_time, 0.0, 1.0e9);
    init_from_configuration(rejoin_time);
    check_parameter(rejoin_time, divide_time, 1.0e9);
    init_from_configuration(partition_speed);
    check_parameter(partition_speed, 0.0, 1000.0);
}

// Whether a robot touches the front of the partition, which is lowered towards +y.
static bool touches_a_robot(pogosim_pose_t const* partition) {
    double const front_mm = partition->y_mm + HALF_LENGTH;
    for (uint32_t i = 0; i < pogosim_world_category_size("robots"); ++i) {
        pogosim_pose_t robot;
        pogosim_world_pose(pogosim_world_object("robots", i), &robot);
        double const ahead_mm = robot.y_mm - front_mm;
        double const aside_mm = fabs(robot.x_mm - partition->x_mm);
        if (aside_mm < HALF_THICKNESS + ROBOT_RADIUS && ahead_mm > 0.0 && ahead_mm < ROBOT_RADIUS + CLEARANCE) {
            return true;
        }
    }
    return false;
}

// Out between divide_time and rejoin_time, then back. It pushes robots aside, but near the wall ahead it waits for
// them: they would be crushed.
static void move_partition(uint32_t partition) {
    double const time_s = pogosim_world_time();
    bool const is_out = time_s >= (double)divide_time && time_s < (double)rejoin_time;
    pogosim_pose_t pose;
    pogosim_world_pose(partition, &pose);
    double const way_mm = (double)partition_speed * GLOBAL_STEP;
    double const next = is_out ? fmin(shut + way_mm, TRAVEL) : fmax(shut - way_mm, 0.0);
    bool const waits = next > shut && TRAVEL - shut < NEAR && touches_a_robot(&pose);
    if (!waits && next != shut && pogosim_world_set_pose(partition, pose.x_mm, RECESS_Y + next, 0.0)) {
        shut = next;
    }
}

// Shares of the pairs of robots that have the same word: within the halves left and right of x, and across.
static void measure_identity(double x_mm) {
    uint32_t same[2] = {0, 0}, pairs[2] = {0, 0};
    uint32_t const nb = pogosim_world_category_size("robots");
    for (uint32_t i = 0; i < nb; ++i) {
        uint32_t const one = pogosim_world_object("robots", i);
        pogosim_pose_t one_pose;
        pogosim_world_pose(one, &one_pose);
        for (uint32_t j = 0; j < i; ++j) {
            uint32_t const other = pogosim_world_object("robots", j);
            pogosim_pose_t other_pose;
            pogosim_world_pose(other, &other_pose);
            bool const is_across = (one_pose.x_mm < x_mm) != (other_pose.x_mm < x_mm);
            USERDATA const* const one_data = (USERDATA const*)pogosim_world_user_data(one);
            USERDATA const* const other_data = (USERDATA const*)pogosim_world_user_data(other);
            same[is_across] += one_data->word == other_data->word;
            pairs[is_across]++;
        }
    }
    pogosim_world_set_column("same_within", pairs[0] > 0 ? (double)same[0] / pairs[0] : (double)NAN);
    pogosim_world_set_column("same_across", pairs[1] > 0 ? (double)same[1] / pairs[1] : (double)NAN);
}

static void global_step(void) {
    if (pogosim_world_category_size("partition") == 0) {
        return;
    }
    uint32_t const partition = pogosim_world_object("partition", 0);
    move_partition(partition);
    pogosim_world_set_column("shut", shut / TRAVEL);
    if (pogosim_world_time() >= next_measurement_s) {
        next_measurement_s += MEASURING_PERIOD;
        pogosim_pose_t pose;
        pogosim_world_pose(partition, &pose);
        measure_identity(pose.x_mm);
    }
}

static void create_data_schema(void) {
    data_add_column_double("shut");         // 0: the partition is in its recess; 1: the swarm is divided
    data_add_column_double("same_within");  // share of the pairs of robots of the same half that have the same word
    data_add_column_double("same_across");  // share of the pairs of different halves
    data_add_column_int64("word");
}

static void export_data(void) {
    data_set_value_int64("word", (int64_t)mydata->word);
}

#endif

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_global_step, global_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}

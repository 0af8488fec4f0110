// Vicsek: robots that head where their neighbours head on average flock together, unless there is too much noise
// (T. Vicsek, A. Czirok, E. Ben-Jacob, I. Cohen, O. Shochet, "Novel type of phase transition in a system of self-driven
// particles", Physical Review Letters 75, 1995).
//
// Shows: a compass made of three photosensors and the gyroscope, steering by feedback, messages with a quantity in
// them.
//
// All robots drive at the same speed. Every `update_period` each takes a new course: the mean direction of itself and
// its neighbours, plus an error drawn uniformly from -noise_eta/2 to noise_eta/2. The order parameter is the length of
// the mean of all heading vectors: near 1 if noise_eta is small, 1 / sqrt(number of robots) if it is 2 pi.
//
// Neighbours must know their headings with respect to the same axis, but a Pogobot has no compass. A lamp to one side
// replaces it: light that increases linearly across the arena (a `plane` lamp) shows each robot the same direction. The
// difference between front and back photosensors is proportional to cos(heading), that between left and right ones to
// sin(heading), where heading 0 is towards the light. Where the light gives no direction, in the dark or across the
// seam of the arena, the heading follows the gyroscope. With no such light at all it starts from 0: then place the
// robots in parallel (`aligned_random`).
//
// There is no avoidance of walls: the arena is periodic. Nor of robots: in one run of ten or so, robots of different
// courses block each other and mill about one point for minutes, instead of flocking.
//
//     ./examples/vicsek/vicsek -c conf/vicsek.yaml
#include <math.h>

#include "pogobase.h"

#define PI 3.14159265f
#define MAX_NEIGHBORS 20
#define MAX_AGE_MS 200
#define HEADING_UNITS (32767.0f / PI)  // of the messages: pi is 32767
#define COS_40_DEG 0.76604444f         // the front photosensors sit 40 degrees to the left and right, the other behind
#define SIN_40_DEG 0.64278761f
#define BRIGHTEST 32767        // what a saturated photosensor reads
#define MIN_CONTRAST 50.0f     // smaller differences between photosensors say nothing about the direction of the light
#define MAX_CONTRAST 10000.0f  // larger ones are the edge of a shadow, or the seam of the arena
#define LIGHT_TRUST 0.2f       // share of the compass's error that is corrected at each tick
#define TURN_GAIN 1.0f         // full turn for a course this many radians away

typedef enum { BACK, FRONT_LEFT, FRONT_RIGHT } photosensor_t;

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    int16_t heading;
} message_content_t;

typedef struct {
    uint16_t id;
    float heading;
    uint32_t heard_ms;
} neighbor_t;

typedef struct {
    float heading;  // rad, -pi to pi, clockwise seen from above; 0: towards the light
    bool light_was_seen;
    float course;  // heading to be
    uint32_t next_update_ms;
    time_reference_t last_tick;
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float noise_eta = 0.5f;        // rad, width of the noise, 0 to 2 pi
uint32_t update_period = 250;  // ms between two choices of a course
float speed_frac = 0.5f;       // of the highest speed; at 0.5 robots turn as fast as they can without slowing down

static float wrapped(float angle) {
    return angle > PI ? angle - 2.0f * PI : angle < -PI ? angle + 2.0f * PI : angle;
}

// ---- Compass ----

// Sets the heading with respect to the light; false if the light gives no direction.
static bool read_light_compass(float* heading) {
    float const back = pogobot_photosensors_read(BACK);
    float const left = pogobot_photosensors_read(FRONT_LEFT);
    float const right = pogobot_photosensors_read(FRONT_RIGHT);
    float const lowest = fminf(back, fminf(left, right));
    float const highest = fmaxf(back, fmaxf(left, right));
    float const contrast = highest - lowest;
    if (highest >= BRIGHTEST || contrast < MIN_CONTRAST || contrast > MAX_CONTRAST) {
        return false;
    }
    // The light's gradient, seen from the robot: ahead and to the right.
    float const ahead = ((left + right) / 2.0f - back) / (1.0f + COS_40_DEG);
    float const rightwards = (right - left) / (2.0f * SIN_40_DEG);
    *heading = -atan2f(rightwards, ahead);
    return true;
}

static void update_heading(void) {
    float acceleration[3], gyro[3];
    pogobot_imu_read(acceleration, gyro);
    float const dt_s = (float)pogobot_stopwatch_lap(&mydata->last_tick) * 1e-6f;
    mydata->heading = wrapped(mydata->heading - gyro[2] * dt_s);  // the gyroscope counts to the left

    float light_heading;
    if (read_light_compass(&light_heading)) {
        float const trust = mydata->light_was_seen ? LIGHT_TRUST : 1.0f;
        mydata->heading = wrapped(mydata->heading + trust * wrapped(light_heading - mydata->heading));
        mydata->light_was_seen = true;
    }
}

// ---- Flocking ----

static void forget_silent_neighbors(void) {
    uint8_t kept = 0;
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        if (current_time_milliseconds() - mydata->neighbors[i].heard_ms <= MAX_AGE_MS) {
            mydata->neighbors[kept++] = mydata->neighbors[i];
        }
    }
    mydata->nb_neighbors = kept;
}

static void choose_course(void) {
    float x = cosf(mydata->heading), y = sinf(mydata->heading);
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        x += cosf(mydata->neighbors[i].heading);
        y += sinf(mydata->neighbors[i].heading);
    }
    float const noise = noise_eta * ((float)rand() / (float)RAND_MAX - 0.5f);
    mydata->course = wrapped(atan2f(y, x) + noise);
}

// Turns towards the course at constant speed: what one motor gains the other loses.
static void steer(void) {
    float const error = wrapped(mydata->course - mydata->heading);
    float const most = fminf(speed_frac, 1.0f - speed_frac);
    float const turn = fmaxf(-most, fminf(TURN_GAIN * most * error, most));
    pogobot_motor_set(motorL, (uint16_t)((speed_frac + turn) * motorFull));
    pogobot_motor_set(motorR, (uint16_t)((speed_frac - turn) * motorFull));
}

static void show_heading(void) {
    uint8_t r, g, b;
    rainbow_colormap((uint8_t)((mydata->heading + PI) / (2.0f * PI) * 255.0f), &r, &g, &b);
    pogobot_led_setColor(r, g, b);
}

// ---- Messages ----

static bool send_heading(void) {
    message_content_t message = {.sender_id = pogobot_helper_getid(),
                                 .heading = (int16_t)(mydata->heading * HEADING_UNITS)};
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
    mydata->neighbors[place] = (neighbor_t){.id = message.sender_id,
                                            .heading = (float)message.heading / HEADING_UNITS,
                                            .heard_ms = current_time_milliseconds()};
}

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
    main_loop_hz = 60;
    max_nb_processed_msg_per_tick = NUMEL;  // all that the queue holds
    percent_msgs_sent_per_ticks = 30;
    msg_rx_fn = process_message;
    msg_tx_fn = send_heading;
    pogobot_stopwatch_reset(&mydata->last_tick);
}

void user_step(void) {
    update_heading();
    forget_silent_neighbors();
    if (current_time_milliseconds() >= mydata->next_update_ms) {
        mydata->next_update_ms += update_period;
        choose_course();
    }
    steer();
    show_heading();
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

static void global_setup(void) {
    init_from_configuration(noise_eta);
    check_parameter(noise_eta, 0, 2 * PI);
    init_from_configuration(update_period);
    check_parameter(update_period, 1, MAX_DURATION_MS);
    init_from_configuration(speed_frac);
    check_parameter(speed_frac, 0, 1);
}

static void create_data_schema(void) {
    data_add_column_double("heading");
    data_add_column_int8("nb_neighbors");
}

static void export_data(void) {
    data_set_value_double("heading", mydata->heading);
    data_set_value_int8("nb_neighbors", mydata->nb_neighbors);
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

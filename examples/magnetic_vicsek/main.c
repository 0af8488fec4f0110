// Vicsek's flock by compass: robots that head where their neighbours head on average, each knowing its heading by its
// magnetometer (T. Vicsek, A. Czirok, E. Ben-Jacob, I. Cohen, O. Shochet, "Novel type of phase transition in a system
// of self-driven particles", Physical Review Letters 75, 1995).
//
// Shows: what the magnetometer is good for in a swarm, a calibration that is kept in flash.
//
// The example vicsek needs a lamp for robots to have the same axes. Here the magnetic field gives them. A robot whose
// flash is blank turns for 10 s first, fits the ellipse of its readings and keeps it (magnetic_compass/compass.h); in
// later runs with the same `flash_state` all begin to flock at once.
//
// All robots drive at the same speed. Every `update_period` each takes a new course: the mean direction of itself and
// its neighbours, plus an error drawn uniformly from -noise_eta/2 to noise_eta/2. The order parameter is the length of
// the mean of all heading vectors: near 1 if noise_eta is small, 1 / sqrt(number of robots) if it is 2 pi. Errors of
// compasses act as a little noise; one that is the same in all robots does not matter.
//
//     ./examples/magnetic_vicsek/magnetic_vicsek -c conf/magnetic_vicsek.yaml
#include <math.h>

#include "../magnetic_compass/compass.h"
#include "pogobase.h"

#define PI 3.14159265f
#define MAX_NEIGHBORS 20
#define MAX_AGE_MS 200
#define HEADING_UNITS (32767.0f / PI)  // of the messages: pi is 32767
#define READING_TIMEOUT_MS 20
#define CALIBRATION_MS 10000
#define TURN_GAIN 1.0f  // full turn for a course this many radians away

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
    compass_readings_t readings;
    compass_t compass;
    bool is_calibrated;
    uint32_t calibrated_at_ms;  // or not, and tries again
    float heading;              // rad, -pi to pi, clockwise seen from above; 0: magnetic north
    float course;               // heading to be
    uint32_t next_update_ms;
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

// Turns, and adds readings. A robot that others have kept from turning tries again.
static void calibrate(int16_t x, int16_t y) {
    pogobot_motor_set(motorL, motorHalf);
    pogobot_motor_set(motorR, motorStop);
    compass_add(&mydata->readings, x, y);
    if (current_time_milliseconds() < mydata->calibrated_at_ms) {
        return;
    }
    mydata->is_calibrated = compass_fit(&mydata->readings, &mydata->compass);
    if (mydata->is_calibrated) {
        compass_save(&mydata->compass);
    } else {
        mydata->readings.count = 0;
        mydata->calibrated_at_ms = current_time_milliseconds() + CALIBRATION_MS;
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

// White while it calibrates, then the colour of its heading.
static void show_heading(void) {
    uint8_t r = 5, g = 5, b = 5;
    if (mydata->is_calibrated) {
        rainbow_colormap((uint8_t)((mydata->heading + PI) / (2.0f * PI) * 255.0f), &r, &g, &b);
    }
    pogobot_led_setColor(r, g, b);
}

// ---- Messages ----

static bool send_heading(void) {
    if (!mydata->is_calibrated) {
        return false;
    }
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
    mydata->is_calibrated = compass_load(&mydata->compass);
    mydata->calibrated_at_ms = CALIBRATION_MS;
}

void user_step(void) {
    int16_t x, y, z;
    forget_silent_neighbors();
    if (magn_read_XYZ(&x, &y, &z, READING_TIMEOUT_MS) != 0) {
        return;
    }
    if (!mydata->is_calibrated) {
        calibrate(x, y);
    } else {
        mydata->heading = compass_heading(&mydata->compass, x, y);
        if (current_time_milliseconds() >= mydata->next_update_ms) {
            mydata->next_update_ms = current_time_milliseconds() + update_period;
            choose_course();
        }
        steer();
    }
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
    data_add_column_bool("is_calibrated");
    data_add_column_double("heading");
    data_add_column_int8("nb_neighbors");
}

static void export_data(void) {
    data_set_value_bool("is_calibrated", mydata->is_calibrated);
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

// Toner and Tu's flock: velocities that obey an equation of motion, from rest to a flock (J. Toner, Y. Tu, "Long-range
// order in a two-dimensional dynamical XY model: how birds fly together", Physical Review Letters 75, 1995; "Flocks,
// herds, and schools: a quantitative theory of flocking", Physical Review E 58, 1998).
//
// Shows: a stochastic differential equation of a vector, dead reckoning with the gyroscope, directions from the faces
// that hear a message, steering.
//
// The theory describes a flock as a fluid that drives itself. Here each robot carries the velocity v of the fluid at
// its place; its neighbours, as it hears them, stand for the derivatives:
//
//     dv / dt = (alpha - beta |v|^2) v
//               + alignment * (mean velocity of the neighbours - v)
//               - pressure * (sum of the directions of the neighbours)
//               + random force
//
// Propulsion: rest is unstable if alpha > 0, and the speed of the flock is sqrt(alpha / beta). Alignment is the
// viscosity, and pressure drives robots away from where more neighbours are. The random force alone would take each
// component of v to noise * sqrt(t). The fluid moves with the robots, so that its convective terms need nothing.
//
// A robot drives at |v| in the direction of v. With alpha > 0 and little noise all end up with one velocity, though no
// direction is better than another; with too much noise, or alpha < 0, they have none in common. The order parameter is
// the length of the sum of all velocities divided by the sum of their lengths.
//
// To compare velocities, robots need the same axes. Put them down in parallel (aligned_random): from then on each
// integrates its gyroscope. The arena is periodic. Colours show the direction of v.
//
//     ./examples/toner_tu/toner_tu -c conf/toner_tu.yaml
#include <math.h>

#include "pogobase.h"

#define PI 3.14159265f
#define MAX_NEIGHBORS 20
#define NB_FACES 4
#define MAX_AGE_MS 200
#define COPY_MS 8             // copies of one message, heard by several faces, come within this time
#define TOP_SPEED 100.0f      // mm/s, of the robot
#define VELOCITY_UNITS 32.0f  // of the messages: 32 are 1 mm/s
#define TURN_GAIN 2.0f        // at top speed: share of the motors' power for each radian that the direction is away
#define MAX_TURN 0.5f         // of the motors' power

typedef struct {
    float x, y;  // y is to the right of x, as in the simulator
} vector_t;

typedef struct __attribute__((__packed__)) {
    uint16_t sender_id;
    int16_t velocity_x;
    int16_t velocity_y;
} message_content_t;

typedef struct {
    uint16_t id;
    uint8_t faces;  // that heard its last message, a bit each
    vector_t velocity;
    uint32_t heard_ms;
} neighbor_t;

typedef struct {
    vector_t velocity;  // that the robot wants, mm/s
    float heading;      // rad, -pi to pi, clockwise seen from above; 0 at the start
    time_reference_t last_tick;
    neighbor_t neighbors[MAX_NEIGHBORS];
    uint8_t nb_neighbors;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float alpha = 1.0f;      // 1/s
float beta = 4.0e-4f;    // s/mm^2: the flock moves at 50 mm/s
float alignment = 3.0f;  // 1/s
float pressure = 20.0f;  // mm/s^2 for each neighbour
float noise = 10.0f;     // mm/s per square root of a second, each component

static float wrapped(float angle) {
    return angle > PI ? angle - 2.0f * PI : angle < -PI ? angle + 2.0f * PI : angle;
}

static float length(vector_t v) {
    return sqrtf(v.x * v.x + v.y * v.y);
}

// Uniform, with mean 0 and variance 1.
static float random_number(void) {
    return 3.46410162f * ((float)rand() / (float)RAND_MAX - 0.5f);
}

// ---- The equation ----

// Direction of a neighbour, of length 1: between the faces that hear it.
static vector_t direction_of(neighbor_t const* neighbor) {
    vector_t sum = {0.0f, 0.0f};
    for (uint8_t face = 0; face < NB_FACES; face++) {  // in front, to the right, behind, to the left
        if (neighbor->faces >> face & 1) {
            sum.x += cosf(mydata->heading + PI / 2.0f * (float)face);
            sum.y += sinf(mydata->heading + PI / 2.0f * (float)face);
        }
    }
    float const norm = fmaxf(length(sum), 1.0e-6f);
    return (vector_t){sum.x / norm, sum.y / norm};
}

// What neighbours do to the velocity, mm/s^2.
static vector_t interaction(void) {
    vector_t force = {0.0f, 0.0f};
    for (uint8_t i = 0; i < mydata->nb_neighbors; i++) {
        neighbor_t const* neighbor = &mydata->neighbors[i];
        vector_t const direction = direction_of(neighbor);
        float const share = alignment / (float)mydata->nb_neighbors;
        force.x += share * (neighbor->velocity.x - mydata->velocity.x) - pressure * direction.x;
        force.y += share * (neighbor->velocity.y - mydata->velocity.y) - pressure * direction.y;
    }
    return force;
}

// One step of the method of Euler and Maruyama. A robot is no faster than its motors.
static void update_velocity(float dt_s) {
    vector_t* const v = &mydata->velocity;
    float const propulsion = alpha - beta * (v->x * v->x + v->y * v->y);
    vector_t const force = interaction();
    float const random_force = noise * sqrtf(dt_s);
    v->x += (propulsion * v->x + force.x) * dt_s + random_force * random_number();
    v->y += (propulsion * v->y + force.y) * dt_s + random_force * random_number();
    float const speed = length(*v);
    if (speed > TOP_SPEED) {
        v->x *= TOP_SPEED / speed;
        v->y *= TOP_SPEED / speed;
    }
}

// ---- Body ----

static void update_heading(float dt_s) {
    float acceleration[3], gyro[3];
    pogobot_imu_read(acceleration, gyro);
    mydata->heading = wrapped(mydata->heading - gyro[2] * dt_s);  // the gyroscope counts to the left
}

// Turns towards the velocity, slowly if it is small, and drives at the part of it that is ahead.
static void steer(void) {
    float const speed = length(mydata->velocity) / TOP_SPEED;
    float const error = wrapped(atan2f(mydata->velocity.y, mydata->velocity.x) - mydata->heading);
    float const turn = fmaxf(-MAX_TURN, fminf(TURN_GAIN * speed * error, MAX_TURN));
    float const ahead = fminf(fmaxf(speed * cosf(error), 0.0f), 1.0f - fabsf(turn));
    pogobot_motor_set(motorL, (uint16_t)(fmaxf(ahead + turn, 0.0f) * motorFull));
    pogobot_motor_set(motorR, (uint16_t)(fmaxf(ahead - turn, 0.0f) * motorFull));
}

static void show_direction(void) {
    uint8_t r, g, b;
    float const direction = atan2f(mydata->velocity.y, mydata->velocity.x);
    rainbow_colormap((uint8_t)((direction + PI) / (2.0f * PI) * 255.0f), &r, &g, &b);
    pogobot_led_setColor(r, g, b);
}

// ---- Messages ----

static bool send_velocity(void) {
    message_content_t message = {.sender_id = pogobot_helper_getid(),
                                 .velocity_x = (int16_t)(mydata->velocity.x * VELOCITY_UNITS),
                                 .velocity_y = (int16_t)(mydata->velocity.y * VELOCITY_UNITS)};
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
    uint32_t const now = current_time_milliseconds();
    neighbor_t* neighbor = &mydata->neighbors[place];
    bool const is_copy = place < mydata->nb_neighbors && now - neighbor->heard_ms < COPY_MS;
    mydata->nb_neighbors += place == mydata->nb_neighbors;
    uint8_t const face = (uint8_t)(1u << received->header._receiver_ir_index);
    neighbor->id = message.sender_id;
    neighbor->faces = is_copy ? neighbor->faces | face : face;
    neighbor->velocity =
        (vector_t){(float)message.velocity_x / VELOCITY_UNITS, (float)message.velocity_y / VELOCITY_UNITS};
    neighbor->heard_ms = now;
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
    msg_tx_fn = send_velocity;
    pogobot_stopwatch_reset(&mydata->last_tick);
}

void user_step(void) {
    float const dt_s = (float)pogobot_stopwatch_lap(&mydata->last_tick) * 1e-6f;
    update_heading(dt_s);
    forget_silent_neighbors();
    update_velocity(dt_s);
    steer();
    show_direction();
}

#ifdef SIMULATOR
static void global_setup(void) {
    // Larger rates would be too fast for ticks of 1/60 s.
    init_from_configuration(alpha);
    check_parameter(alpha, -20, 20);
    init_from_configuration(beta);
    check_parameter(beta, 0, 0.01);
    init_from_configuration(alignment);
    check_parameter(alignment, 0, 20);
    init_from_configuration(pressure);
    check_parameter(pressure, 0, 1000);
    init_from_configuration(noise);
    check_parameter(noise, 0, 1000);
}

static void create_data_schema(void) {
    data_add_column_double("velocity_x");  // mm/s, that the robot wants, in the axes of its heading at the start
    data_add_column_double("velocity_y");
    data_add_column_double("heading");
    data_add_column_int8("nb_neighbors");
}

static void export_data(void) {
    data_set_value_double("velocity_x", mydata->velocity.x);
    data_set_value_double("velocity_y", mydata->velocity.y);
    data_set_value_double("heading", mydata->heading);
    data_set_value_int8("nb_neighbors", (int8_t)mydata->nb_neighbors);
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

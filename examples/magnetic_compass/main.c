// Magnetic compass: robots that calibrate their magnetometers by turning, keep the calibration in flash, and drive
// straight by it the next time they are switched on.
//
// Shows: the magnetometer, flash memory that outlasts a run, a program with phases, proportional-integral control
// (K. J. Astrom, T. Hagglund, "PID Controllers", 1995).
//
// As a robot turns, the two horizontal readings of its magnetometer describe an ellipse, whose centre and axes differ
// from robot to robot. A robot whose flash is blank turns for `calibration_time`, fits the ellipse (compass.h), and
// writes it into flash. A robot that finds an ellipse there takes it as its compass: it turns to `course` and holds it,
// though its motors are not equally strong. The head is blue while a robot calibrates, green once it has written the
// ellipse, white while it drives, and red if it has found no ellipse.
//
// Run it twice: `flash_state` in the configuration keeps the flash memories of all robots in a file.
//
//     ./examples/magnetic_compass/magnetic_compass -c conf/magnetic_compass.yaml
//     ./examples/magnetic_compass/magnetic_compass -c conf/magnetic_compass.yaml
//
// To see what the compass is good for, run it a third time with `--set parameters.use_compass=false`. Robots calibrate
// anew once the file is gone.
#include <math.h>

#include "compass.h"
#include "pogobase.h"

#define READING_TIMEOUT_MS 20
#define TURN_GAIN 0.5f      // share of the motors' power for each radian
#define INTEGRAL_GAIN 0.3f  // the same for each radian and second
#define MAX_INTEGRAL 1.0f   // rad s
#define BRIGHTEST 25        // of the LEDs

typedef enum { CALIBRATING, CALIBRATED, NO_ELLIPSE, DRIVING } phase_t;

typedef struct {
    phase_t phase;
    compass_readings_t readings;
    compass_t compass;
    int16_t x, y, z;  // the last reading
    float heading;    // rad, -pi to pi, clockwise seen from above; 0: magnetic north
    float integral;   // of the error, rad s
    time_reference_t last_tick;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
uint32_t calibration_time = 10000;  // ms of turning, the first COMPASS_MAX_READINGS readings of which count
float course = 0.0f;                // rad, clockwise from magnetic north
float speed_frac = 0.6f;            // of the highest speed
bool use_compass = true;

static float wrapped(float angle) {
    return angle > COMPASS_PI ? angle - 2.0f * COMPASS_PI : angle < -COMPASS_PI ? angle + 2.0f * COMPASS_PI : angle;
}

static void set_motors(float left, float right) {
    pogobot_motor_set(motorL, (uint16_t)(fmaxf(0.0f, fminf(left, 1.0f)) * motorFull));
    pogobot_motor_set(motorR, (uint16_t)(fmaxf(0.0f, fminf(right, 1.0f)) * motorFull));
}

// ---- Calibration ----

static void calibrate(bool has_reading) {
    set_motors(0.5f, 0.0f);
    if (has_reading) {
        compass_add(&mydata->readings, mydata->x, mydata->y);
    }
    if (current_time_milliseconds() >= calibration_time) {
        set_motors(0.0f, 0.0f);
        if (compass_fit(&mydata->readings, &mydata->compass)) {
            compass_save(&mydata->compass);
            mydata->phase = CALIBRATED;
        } else {
            mydata->phase = NO_ELLIPSE;
            printf("no ellipse in %u readings: does the robot turn, and has it a magnetometer?\n",
                   (unsigned)mydata->readings.count);
        }
    }
}

// ---- Driving ----

// The integral grows until it makes up for motors that are not equally strong. It waits while the robot turns to its
// course.
static void steer(float dt_s) {
    float const error = wrapped(course - mydata->heading);
    if (fabsf(error) < 0.5f) {
        mydata->integral = fmaxf(-MAX_INTEGRAL, fminf(mydata->integral + error * dt_s, MAX_INTEGRAL));
    }
    float const most = fminf(speed_frac, 1.0f - speed_frac);
    float const turn = fmaxf(-most, fminf(TURN_GAIN * error + INTEGRAL_GAIN * mydata->integral, most));
    set_motors(speed_frac + turn, speed_frac - turn);
}

static void drive(bool has_reading, float dt_s) {
    if (!use_compass) {
        set_motors(speed_frac, speed_frac);
    } else if (has_reading) {
        mydata->heading = compass_heading(&mydata->compass, mydata->x, mydata->y);
        steer(dt_s);
    }
}

static void show_phase(void) {
    bool const drives = mydata->phase == DRIVING;
    pogobot_led_setColor(mydata->phase == NO_ELLIPSE || drives ? BRIGHTEST : 0,
                         mydata->phase == CALIBRATED || drives ? BRIGHTEST : 0,
                         mydata->phase == CALIBRATING || drives ? BRIGHTEST : 0);
}

void user_init(void) {
    main_loop_hz = 60;
    percent_msgs_sent_per_ticks = 0;
    mydata->phase = compass_load(&mydata->compass) ? DRIVING : CALIBRATING;
    pogobot_stopwatch_reset(&mydata->last_tick);
}

void user_step(void) {
    float const dt_s = (float)pogobot_stopwatch_lap(&mydata->last_tick) * 1e-6f;
    bool const has_reading = magn_read_XYZ(&mydata->x, &mydata->y, &mydata->z, READING_TIMEOUT_MS) == 0;
    if (mydata->phase == CALIBRATING) {
        calibrate(has_reading);
    } else if (mydata->phase == DRIVING) {
        drive(has_reading, dt_s);
    }
    show_phase();
}

#ifdef SIMULATOR
#define MAX_DURATION_MS 10000000  // nearly three hours

static void global_setup(void) {
    init_from_configuration(calibration_time);
    check_parameter(calibration_time, 0, MAX_DURATION_MS);
    init_from_configuration(course);
    check_parameter(course, -COMPASS_PI, COMPASS_PI);
    init_from_configuration(speed_frac);
    check_parameter(speed_frac, 0, 1);
    init_from_configuration(use_compass);
}

static void create_data_schema(void) {
    data_add_column_int8("phase");  // 0: calibrates, 1: has calibrated, 2: found no ellipse, 3: drives
    data_add_column_int16("magnetic_x");
    data_add_column_int16("magnetic_y");
    data_add_column_double("heading");
    data_add_column_double("centre_x");
    data_add_column_double("centre_y");
    data_add_column_double("major_radius");
    data_add_column_double("minor_radius");
}

static void export_data(void) {
    data_set_value_int8("phase", (int8_t)mydata->phase);
    data_set_value_int16("magnetic_x", mydata->x);
    data_set_value_int16("magnetic_y", mydata->y);
    data_set_value_double("heading", mydata->heading);
    data_set_value_double("centre_x", mydata->compass.centre_x);
    data_set_value_double("centre_y", mydata->compass.centre_y);
    data_set_value_double("major_radius", mydata->compass.major);
    data_set_value_double("minor_radius", mydata->compass.minor);
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

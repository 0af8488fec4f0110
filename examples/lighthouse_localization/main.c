// Lighthouse localization: robots find out where they are from the times at which two beams of light pass them.
//
// The idea is that of the tracking in Valve's SteamVR, which small drones use, too (A. Taffanel et al., "Lighthouse
// positioning system: dataset, accuracy, and precision for UAV research", arXiv:2104.11523, 2021).
//
// Shows: reading the photosensors in every tick, a program driven by them, geometry on the robot, columns of its own in
// the data file.
//
// Two lighthouses stand in two corners of a square map. What a robot sees, over and over:
//
//     long white     everything is bright for 0.5 s
//     ray 1          a beam from lighthouse 1 turns from -90 to 0 degrees, clockwise on the screen, at 3 rad/s
//     short white    everything is bright for 0.1 s
//     ray 2          a beam from lighthouse 2 turns from -180 to -90 degrees
//
// The time from the end of a white frame until the beam passes gives the direction in which that lighthouse sees the
// robot, and two directions cross in one point:
//
//           . robot         Positions are those of a map from -0.75 to 0.75 with the lighthouses in its corners
//         .   .             (-0.75, 0.75) and (0.75, 0.75). y points down on the screen. On a square map of side L,
//       .       .           x_mm = L / 2 * (1 + x / 0.75), and the same for y.
//     1           2
//
// A robot looks every 16 ms, during which a beam turns by 0.05 rad: this limits the accuracy to a few centimetres on a
// square metre. What has changed between two ticks changed midway between them, on average.
//
// Head LED: the hue is the direction from the centre of the map; red when the position is not known. LED 1: the hue is
// the distance from there; white when the position is not known.
//
//     ./examples/lighthouse_localization/lighthouse_localization -c conf/lighthouse.yaml
#include "pogobase.h"

#include <math.h>

#define PI 3.14159265f
#define NB_SENSORS 3
#define WHITE_LEVEL 1000      // a white frame: all sensors read at least this. Beams have to be weaker
#define SWEEP_TOLERANCE 1.5f  // a sweep that takes this many times too long: the lighthouses are off
#define MIN_DETERMINANT 1e-6f

// Which beam turns. After a long white frame it is ray 1, after a short one ray 2, if ray 1 was before.
typedef enum { NO_RAY, RAY_1, RAY_2 } ray_t;

typedef struct {
    ray_t ray;
    bool is_white;
    uint32_t last_tick_ms;
    uint32_t white_start_ms;
    uint32_t twice_white_end_ms;  // twice the time in the middle between the last white tick and the one after it
    int16_t dark_level;           // darkest since the white frame: beams are brighter
    bool beam_seen;               // since the white frame
    uint32_t beam_first_ms;       // first and last tick in the beam
    uint32_t beam_last_ms;
    float delay_s[RAY_2 + 1];  // from the white frame until the beam of each ray; negative when it was missed
    bool pose_valid;
    float x;  // the last valid position
    float y;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots. The first three have to match the lighthouses.
float lighthouse_omega = 1.0f;  // rad/s
float long_white_duration_s = 0.5f;
float short_white_duration_s = 0.1f;
float edge_delta = 50.0f;           // a beam is brighter than the dark by more than this, sensor counts
float max_dist_from_center = 1.5f;  // |x| and |y| beyond this are wrong
float lighthouse1_x = -0.75f;
float lighthouse1_y = 0.75f;
float lighthouse2_x = 0.75f;
float lighthouse2_y = 0.75f;

/* ---- position from two directions ---- */

static float sweep_duration_s(void) {
    return 0.5f * PI / lighthouse_omega;
}

// Where the half-lines from the lighthouses, at the angles of the two delays, cross. False if they do not.
static bool locate(float* x, float* y) {
    if (mydata->delay_s[RAY_1] < 0.0f || mydata->delay_s[RAY_2] < 0.0f) {
        return false;
    }
    float const theta1 = -0.5f * PI + lighthouse_omega * mydata->delay_s[RAY_1];
    float const theta2 = PI + lighthouse_omega * mydata->delay_s[RAY_2];
    float const c1 = cosf(theta1), s1 = sinf(theta1), c2 = cosf(theta2), s2 = sinf(theta2);
    // L1 + a (c1, s1) = L2 + b (c2, s2), solved for a by Cramer's rule.
    float const determinant = c1 * s2 - s1 * c2;
    if (fabsf(determinant) < MIN_DETERMINANT) {
        return false;
    }
    float const dx = lighthouse2_x - lighthouse1_x, dy = lighthouse2_y - lighthouse1_y;
    float const a = (dx * s2 - dy * c2) / determinant;
    float const b = (dx * s1 - dy * c1) / determinant;
    *x = lighthouse1_x + a * c1;
    *y = lighthouse1_y + a * s1;
    return a >= 0.0f && b >= 0.0f && fabsf(*x) <= max_dist_from_center && fabsf(*y) <= max_dist_from_center;
}

static void show_hue(uint8_t led, float degrees) {
    uint8_t r, g, b;
    hsv_to_rgb(degrees, 1.0f, 1.0f, &r, &g, &b);
    pogobot_led_setColors(SCALE_0_255_TO_0_25(r), SCALE_0_255_TO_0_25(g), SCALE_0_255_TO_0_25(b), led);
}

static void show_pose(void) {
    if (!mydata->pose_valid) {
        pogobot_led_setColors(25, 0, 0, 0);
        pogobot_led_setColors(25, 25, 25, 1);
        return;
    }
    float const direction = atan2f(mydata->y, mydata->x) * 180.0f / PI;
    show_hue(0, direction < 0.0f ? direction + 360.0f : direction);
    // From red in the centre to violet in a corner.
    float const distance = sqrtf(mydata->x * mydata->x + mydata->y * mydata->y);
    show_hue(1, fminf(270.0f * distance / (1.4142136f * max_dist_from_center), 270.0f));
}

/* ---- what the sensors see ---- */

static void start_sweep(ray_t ray, uint32_t now_ms, int16_t level) {
    mydata->ray = ray;
    mydata->twice_white_end_ms = mydata->last_tick_ms + now_ms;
    mydata->dark_level = level;
    mydata->beam_seen = false;
    if (ray == RAY_1) {
        mydata->delay_s[RAY_1] = mydata->delay_s[RAY_2] = -1.0f;
    }
}

static void watch_for_beam(uint32_t now_ms, int16_t level) {
    if (level < mydata->dark_level) {
        mydata->dark_level = level;
    }
    if ((float)(level - mydata->dark_level) <= edge_delta) {
        return;
    }
    if (!mydata->beam_seen) {
        mydata->beam_seen = true;
        mydata->beam_first_ms = now_ms;
    }
    mydata->beam_last_ms = now_ms;
}

static void end_sweep(void) {
    if (mydata->beam_seen) {
        uint32_t const twice_beam_ms = mydata->beam_first_ms + mydata->beam_last_ms;
        mydata->delay_s[mydata->ray] = 0.0005f * (float)(twice_beam_ms - mydata->twice_white_end_ms);
    }
    if (mydata->ray == RAY_2) {
        float x, y;
        mydata->pose_valid = locate(&x, &y);
        if (mydata->pose_valid) {
            mydata->x = x;
            mydata->y = y;
        }
        show_pose();
    }
}

// The ray that follows a white frame of this duration.
static ray_t ray_after_white(uint32_t duration_ms) {
    float const limit_ms = 500.0f * (long_white_duration_s + short_white_duration_s);
    if ((float)duration_ms > limit_ms) {
        return RAY_1;
    }
    return mydata->ray == RAY_1 ? RAY_2 : NO_RAY;
}

static void read_light(int16_t* darkest, int16_t* brightest) {
    *darkest = *brightest = pogobot_photosensors_read(0);
    for (uint8_t sensor = 1; sensor < NB_SENSORS; sensor++) {
        int16_t const level = pogobot_photosensors_read(sensor);
        *darkest = level < *darkest ? level : *darkest;
        *brightest = level > *brightest ? level : *brightest;
    }
}

/* ---- main loop ---- */

void user_init(void) {
    main_loop_hz = 60;
    mydata->last_tick_ms = current_time_milliseconds();
    show_pose();
}

void user_step(void) {
    uint32_t const now_ms = current_time_milliseconds();
    int16_t darkest, brightest;
    read_light(&darkest, &brightest);

    bool const was_white = mydata->is_white;
    mydata->is_white = darkest >= WHITE_LEVEL;
    if (mydata->is_white && !was_white) {
        mydata->white_start_ms = now_ms;
        end_sweep();
    } else if (!mydata->is_white && was_white) {
        start_sweep(ray_after_white(now_ms - mydata->white_start_ms), now_ms, brightest);
    } else if (!mydata->is_white && mydata->ray != NO_RAY) {
        watch_for_beam(now_ms, brightest);
        float const sweep_s = 0.0005f * (float)(2 * now_ms - mydata->twice_white_end_ms);
        if (sweep_s > SWEEP_TOLERANCE * sweep_duration_s()) {
            end_sweep();
            mydata->ray = NO_RAY;
        }
    }
    mydata->last_tick_ms = now_ms;
}

#ifdef SIMULATOR
static void global_setup(void) {
    init_from_configuration(lighthouse_omega);
    check_parameter(lighthouse_omega, 1e-3, 1e3);
    init_from_configuration(long_white_duration_s);
    check_parameter(long_white_duration_s, 0, 1e6);
    init_from_configuration(short_white_duration_s);
    check_parameter(short_white_duration_s, 0, 1e6);
    init_from_configuration(edge_delta);
    check_parameter(edge_delta, 0, INT16_MAX);
    init_from_configuration(max_dist_from_center);
    check_parameter(max_dist_from_center, 1e-3, 1e6);
    init_from_configuration(lighthouse1_x);
    check_parameter(lighthouse1_x, -1e6, 1e6);
    init_from_configuration(lighthouse1_y);
    check_parameter(lighthouse1_y, -1e6, 1e6);
    init_from_configuration(lighthouse2_x);
    check_parameter(lighthouse2_x, -1e6, 1e6);
    init_from_configuration(lighthouse2_y);
    check_parameter(lighthouse2_y, -1e6, 1e6);
}

static void create_data_schema(void) {
    data_add_column_double("pred_x");
    data_add_column_double("pred_y");
    data_add_column_bool("pose_valid");
}

static void export_data(void) {
    data_set_value_double("pred_x", (double)mydata->x);
    data_set_value_double("pred_y", (double)mydata->y);
    data_set_value_bool("pose_valid", mydata->pose_valid);
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

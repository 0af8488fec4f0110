// Supervisor: foraging, with a part of the program that runs the experiment.
//
// Shows: callback_global_step with the functions of pogosim/world.h: true poses, objects that are moved, lamps that are
// switched and dimmed, a robot that breaks down and is repaired, other robots' variables, columns of the data file that
// belong to the run.
//
// Robots wander at random. A robot that touches a puck has found it: the supervisor counts it, tells the robot, whose
// LED is red for a second, and puts the puck elsewhere. The more have been found, the brighter the lamp in the middle.
// At `failure_time` seconds robot 0 breaks down, and stays where it is until `repair_time`. The columns `found` and
// `fitness` (pucks per minute) are the same in all rows; `meals` is each robot's own.
//
//     ./examples/supervisor/supervisor -c conf/supervisor.yaml
//
// Supervisors are as in Webots (O. Michel, Int. J. Adv. Robot. Syst. 1, 2004); in ARGoS they are loop functions
// (C. Pinciroli et al., Swarm Intell. 6, 2012).
#include <math.h>

#include "pogobase.h"

typedef struct {
    uint32_t turn_until_ms;
    uint32_t run_until_ms;
    bool turns_left;
    uint16_t meals;  // written by the supervisor
    uint16_t meals_seen;
    uint32_t red_until_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

// Parameters, the same for all robots.
float reach = 5.0f;            // mm, from a robot's border to a puck's
float failure_time = 20.0f;    // s
float repair_time = 40.0f;     // s
uint16_t run_duration = 4000;  // ms, the longest

// ---- The robots: a random walk ----

void user_init(void) {
    srand(pogobot_helper_getRandSeed());
}

void user_step(void) {
    uint32_t const now = current_time_milliseconds();
    if (now >= mydata->run_until_ms) {
        mydata->turns_left = rand() % 2 == 0;
        mydata->turn_until_ms = now + (uint32_t)(rand() % 1000);
        mydata->run_until_ms = mydata->turn_until_ms + 1000u + (uint32_t)(rand() % (run_duration + 1));
    }
    bool const turns = now < mydata->turn_until_ms;
    pogobot_motor_set(motorL, turns && mydata->turns_left ? motorStop : motorFull);
    pogobot_motor_set(motorR, turns && !mydata->turns_left ? motorStop : motorFull);

    if (mydata->meals != mydata->meals_seen) {
        mydata->meals_seen = mydata->meals;
        mydata->red_until_ms = now + 1000;
    }
    bool const is_red = now < mydata->red_until_ms;
    pogobot_led_setColor(is_red ? 25 : 0, is_red ? 0 : 25, 0);
}

// ---- The supervisor, in the simulator only ----

#ifdef SIMULATOR

#define ROBOT_RADIUS 26.5  // mm
#define PUCK_RADIUS 20.0   // mm, as in conf/supervisor.yaml

// A variable of the experiment, not of a robot.
POGO_SHARED static uint32_t found = 0;

static void global_setup(void) {
    init_from_configuration(reach);
    check_parameter(reach, 0.0, 1.0e5);
    init_from_configuration(failure_time);
    check_parameter(failure_time, 0.0, 1.0e9);
    init_from_configuration(repair_time);
    check_parameter(repair_time, failure_time, 1.0e9);
    init_from_configuration(run_duration);
    if (pogosim_world_lamp_count() > 0) {
        pogosim_world_set_lamp_on(0, false);  // until something is found
    }
}

// In an arena with walls, not every place is free.
static void put_elsewhere(uint32_t puck, pogosim_pose_t const* pose) {
    bool is_done = false;
    for (int attempt = 0; !is_done && attempt < 100; ++attempt) {
        double const x_mm = pose->x_mm + rand() % 1001 - 500;
        double const y_mm = pose->y_mm + rand() % 1001 - 500;
        is_done = pogosim_world_set_pose(puck, x_mm, y_mm, 0.0);
    }
}

// The robot that touches a puck, or none: the number of objects.
static uint32_t finder_of(pogosim_pose_t const* puck) {
    double const nearest_mm = ROBOT_RADIUS + PUCK_RADIUS + (double)reach;
    for (uint32_t i = 0; i < pogosim_world_category_size("robots"); ++i) {
        uint32_t const robot = pogosim_world_object("robots", i);
        pogosim_pose_t pose;
        pogosim_world_pose(robot, &pose);
        if (hypot(pose.x_mm - puck->x_mm, pose.y_mm - puck->y_mm) < nearest_mm && pogosim_world_is_alive(robot)) {
            return robot;
        }
    }
    return pogosim_world_object_count();
}

static void look_after_pucks(void) {
    for (uint32_t i = 0; i < pogosim_world_category_size("pucks"); ++i) {
        uint32_t const puck = pogosim_world_object("pucks", i);
        pogosim_pose_t pose;
        pogosim_world_pose(puck, &pose);
        uint32_t const finder = finder_of(&pose);
        if (finder < pogosim_world_object_count()) {
            found++;
            ((USERDATA*)pogosim_world_user_data(finder))->meals++;
            put_elsewhere(puck, &pose);
        }
    }
}

static void global_step(void) {
    double const time_s = pogosim_world_time();
    if (pogosim_world_category_size("robots") > 0) {
        bool const works = time_s < (double)failure_time || time_s >= (double)repair_time;
        pogosim_world_set_alive(pogosim_world_object("robots", 0), works);
    }

    uint32_t const before = found;
    look_after_pucks();
    if (found > before && pogosim_world_lamp_count() > 0) {
        pogosim_world_set_lamp_on(0, true);
        pogosim_world_set_lamp_intensity(0, found / 100.0);
    }
    pogosim_world_set_column("found", found);
    pogosim_world_set_column("fitness", time_s > 0.0 ? 60.0 * found / time_s : 0.0);
}

static void create_data_schema(void) {
    data_add_column_int32("found");
    data_add_column_double("fitness");
    data_add_column_int32("meals");
    pogosim_world_set_column("found", 0.0);  // in the rows of time 0
    pogosim_world_set_column("fitness", 0.0);
}

static void export_data(void) {
    data_set_value_int32("meals", mydata->meals);
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

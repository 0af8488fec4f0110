/// @file
/// The supervisor: functions that see and change the whole simulated world. They may be called in the callbacks that
/// run once for the whole run (callback_global_setup, callback_create_data_schema, callback_global_step) and in
/// callback_robot_click, not by robots: a robot knows what it senses and what it is told. What callback_global_step
/// writes is true in the same time step, before the robots run.
///
/// Real robots have none of this: use it inside `#ifdef SIMULATOR`. Errors end the run with a message and exit code 2;
/// each function fails outside of these callbacks, for an index that does not exist, for NULL, and for numbers that are
/// not finite; a column takes NaN for no value.
///
/// Objects are everything that has a body or runs the program: robots, passive objects, walls, membranes. Their index
/// runs from 0 to pogosim_world_object_count() - 1, in the order of the configuration, which is the order of the rows
/// in the data file. Lamps have indices of their own. x is to the right, y down, angles are clockwise on the screen.
#ifndef POGOSIM_WORLD_H
#define POGOSIM_WORLD_H

#include "pogosim/pogolib.h"

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Where an object is.
typedef struct pogosim_pose_t {
    double x_mm;         ///< to the right
    double y_mm;         ///< down
    double heading_rad;  ///< -pi to pi, clockwise on the screen
} pogosim_pose_t;

/// How an object moved in the last step: displacement and turn, by the duration of a step.
typedef struct pogosim_velocity_t {
    double x_mm_s;         ///< to the right
    double y_mm_s;         ///< down
    double angular_rad_s;  ///< clockwise on the screen
} pogosim_velocity_t;

/// Simulated time, s.
/// @range returns s, from 0
double pogosim_world_time(void);

// ---- Objects ----

/// Number of objects.
/// @range returns 0 or more
uint32_t pogosim_world_object_count(void);
/// Number of objects of a category, such as "robots"; 0 for one that the configuration does not have.
/// @range returns 0 or more
uint32_t pogosim_world_category_size(char const* category);
/// Index of an object of a category: `number` is from 0 to pogosim_world_category_size(category) - 1, others and
/// unknown categories are errors.
/// @range number: from 0; returns an index
uint32_t pogosim_world_object(char const* category, uint32_t number);
/// Category of an object, as in the configuration.
char const* pogosim_world_category(uint32_t object);
/// What the data file shows as robot_id.
/// @range returns 0 to 65535
uint32_t pogosim_world_id(uint32_t object);
/// Whether the object runs the program: robots, pogobjects, active objects, walls, membranes.
bool pogosim_world_runs_program(uint32_t object);

/// True pose: of a membrane, its middle; of walls, the centre of their box; heading 0 for both. In a periodic arena,
/// inside its box.
void pogosim_world_pose(uint32_t object, pogosim_pose_t* pose);
/// True velocity, in the last step: of a membrane, the mean of its parts, without rotation. 0 for walls.
void pogosim_world_velocity(uint32_t object, pogosim_velocity_t* velocity);
/// Puts an object elsewhere, at rest; its motors drive it on from there. Returns false, and changes nothing, for a
/// place in a wall or outside of the arena and for walls. Other objects at that place are pushed away. A membrane keeps
/// its orientation.
bool pogosim_world_set_pose(uint32_t object, double x_mm, double y_mm, double heading_rad);

/// Colour of an LED: 0 head, 1 front, 2 right, 3 back, 4 left. Only for objects that run the program.
/// @range led: 0 to 4; r, g, b: 0 to 255
void pogosim_world_led(uint32_t object, uint8_t led, uint8_t* r, uint8_t* g, uint8_t* b);

/// Variables of the object, a USERDATA*, to be read and written; NULL if it runs no program.
void* pogosim_world_user_data(uint32_t object);

/// Whether the object is switched on, as all are at first. True for objects that run no program.
bool pogosim_world_is_alive(uint32_t object);
/// Switches an object off or on. Switched off, it runs no user code and neither sends nor receives messages; its motors
/// stand still and its LEDs are dark. Its body stays, and so do its rows in the data file, with callback_export_data,
/// and callback_robot_end. Switched on, it goes on where it was: variables, motors, LEDs and waiting messages are as
/// they were, and its clock has gone on. Only for objects that run the program.
void pogosim_world_set_alive(uint32_t object, bool alive);

// ---- Light ----

/// Light level on the floor, sensor counts, 0 to 32767, without noise. Outside of the arena, that of its border.
/// @range returns sensor counts, 0 to 32767
double pogosim_world_light_at(double x_mm, double y_mm);
/// Light level at an object: the mean of a robot's three photosensors, without noise or bias; of others, in the middle.
/// @range returns sensor counts, 0 to 32767
double pogosim_world_light(uint32_t object);

/// Number of lamps, in the order of the configuration.
/// @range returns 0 or more
uint32_t pogosim_world_lamp_count(void);
/// Category of a lamp, as in the configuration.
char const* pogosim_world_lamp_category(uint32_t lamp);
///@{
/// Whether a lamp shines when the configuration says so. Switched off, it is dark.
bool pogosim_world_lamp_is_on(uint32_t lamp);
void pogosim_world_set_lamp_on(uint32_t lamp, bool on);
///@}
///@{
/// Brightness of a lamp, at first 1: its levels are those of the configuration times this, at most 32767. At least 0.
/// @range intensity: a factor, from 0
double pogosim_world_lamp_intensity(uint32_t lamp);
void pogosim_world_set_lamp_intensity(uint32_t lamp, double intensity);
///@}
///@{
/// Where a lamp stands, mm; of one on an orbit, the centre of the orbit; of alternating rays, the centre of what they
/// can light. It may be outside of the arena. Light that is the same everywhere stays so.
void pogosim_world_lamp_position(uint32_t lamp, double* x_mm, double* y_mm);
void pogosim_world_set_lamp_position(uint32_t lamp, double x_mm, double y_mm);
///@}

// ---- Links ----

/// What a link does.
typedef enum pogosim_link_kind_t {
    POGOSIM_SPRING,  ///< pulls its ends together when it is longer than at rest, and pushes them apart when shorter
    POGOSIM_ROD,     ///< keeps the distance of its ends
    POGOSIM_HINGE    ///< keeps its ends together; the bodies turn about them
} pogosim_link_kind_t;

/// In place of the second object of a link: the arena.
#define POGOSIM_ARENA UINT32_MAX

/// A link between an object and another one, or a place in the arena.
typedef struct pogosim_link_t {
    pogosim_link_kind_t kind;  ///< what it does
    uint32_t a;                ///< an object
    uint32_t b;                ///< another one, or POGOSIM_ARENA
    double a_x_mm;             ///< end at `a`, from its centre: ahead
    double a_y_mm;             ///< to its right
    double b_x_mm;             ///< end at `b`, likewise; with POGOSIM_ARENA, a place: to the right
    double b_y_mm;             ///< down
    double length_mm;  ///< at rest, 0 or more; NaN: as far apart as its ends are when it is made; 0 or NaN for a hinge
    double stiffness_n_m;  ///< of a spring, 0 or more
    double damping_n_s_m;  ///< of a spring, against changes of its length, 0 or more
    double breaking_n;     ///< a force that is larger cuts it; INFINITY: none does
    double least_rad;      ///< of a hinge: how far `b` may turn against `a`, from how it stands; -INFINITY to 0
    double most_rad;       ///< 0 to INFINITY
} pogosim_link_t;

/// How a link is now.
typedef struct pogosim_link_state_t {
    double length_mm;  ///< distance of its ends
    double tension_n;  ///< force in the last step: positive when it pulls; of a hinge, its magnitude
    bool is_cut;       ///< it does nothing any more
} pogosim_link_state_t;

/// Number of links, those that are cut included, which keep their index: first those of the configuration.
/// @range returns 0 or more
uint32_t pogosim_world_link_count(void);
/// What a link is, as pogosim_world_add_link() takes it.
void pogosim_world_link(uint32_t link, pogosim_link_t* found);
/// How a link is now.
void pogosim_world_link_state(uint32_t link, pogosim_link_state_t* state);
/// What to fill in for a new link between two objects, or an object and the arena: its ends are their centres (where
/// `a` is now, in the arena), of a hinge the place halfway between them; as long as the ends are apart when it is made,
/// without stiffness and damping, of which a spring needs one; and it neither breaks nor has limits. An object that is
/// linked to itself or has no body, a membrane, and two that are fixed, are errors.
/// @range a: an index; b: an index, or POGOSIM_ARENA
pogosim_link_t pogosim_world_new_link(pogosim_link_kind_t kind, uint32_t a, uint32_t b);
/// Makes a link, which holds from this time step on, and returns its index. Numbers outside of their range are errors,
/// as is a rod or a hinge that misses its ends by more than 1 mm.
/// @range returns an index
uint32_t pogosim_world_add_link(pogosim_link_t const* link);
/// Cuts a link, for good. Nothing happens if it is cut already.
void pogosim_world_cut_link(uint32_t link);

// ---- Data file ----

///@{
/// Sets a column of the data file for all objects, or for one: its value in all rows from now on, unless the object's
/// callback_export_data sets another one. The column must have been declared in callback_create_data_schema, in which
/// these functions may be called, too (for the rows of time 0); earlier is an error. Integer columns take whole numbers
/// in their range, bool columns 0 and 1; columns of strings cannot be set. The last call counts. Without a data file,
/// nothing happens.
/// @range value: the range of the column's type
void pogosim_world_set_column(char const* name, double value);
void pogosim_world_set_object_column(uint32_t object, char const* name, double value);
///@}

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif

/// @file
/// Runs inside another process, such as Python: a run is a value that the host advances step by step. Any number
/// of runs may exist, of the same program or others. Several threads may use one run: a call waits for the end of the
/// time step that another thread is making, not for all of its steps. The last call of a run is pogosim_run_close().
/// The package `pogosim` of Python is made with this (`pogosim.Simulation`); it is meant for other languages, too.
///
/// Functions that can fail return a status; pogosim_host_error() then says what, in one line, or in a line for each
/// mistake of a configuration. Pointers are not NULL but where that is said.
///
///     cc host.c $(pkg-config --cflags --libs pogosim-host)
///
/// docs/python.md has an example.
#ifndef POGOSIM_HOST_H
#define POGOSIM_HOST_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// A run.
typedef struct pogosim_run pogosim_run;

/// A copy of the state of a run.
typedef struct pogosim_state pogosim_state;

/// Threads on which many runs go on.
typedef struct pogosim_threads pogosim_threads;

/// An expression of values of robots, such as "light / 1000" or "speed < 1 and heard > 10".
typedef struct pogosim_expression pogosim_expression;

#pragma GCC visibility push(default)  // of functions: what these structs have in C++ stays inside

/// As exit codes of a program. After anything but POGOSIM_OK and POGOSIM_OVER of a step, the run is over and its files
/// are complete.
enum pogosim_status {
    POGOSIM_OK = 0,
    POGOSIM_OVER = 1,            ///< of a step: the simulated time is over, or the program has ended the run
    POGOSIM_USAGE = 2,           ///< wrong arguments or configuration, a file that cannot be written, no memory
    POGOSIM_PROGRAM_FAILED = 3,  ///< the user's program crashed, or did not return
};

struct pogosim_run_options {
    char const* program;          ///< shared object, as `make sim` makes beside the executable, or the ELF file of a
                                  ///< firmware; NULL: none is needed
    char const* configuration;    ///< YAML file
    char const* const* settings;  ///< "key.path=value", as of --set
    size_t setting_count;
    int64_t seed;         ///< 0 to 2^32 - 1; negative: that of the configuration
    int strict;           ///< not 0: unknown keys are errors
    int strict_settings;  ///< not 0: those of the settings are
};

/// An array of the simulator, where it is: it changes with each step, and lives as long as the run. Only those arrays
/// of a brain that say so may be written.
struct pogosim_array {
    void* data;
    char type[8];    ///< as of NumPy's array interface: "<f4", "|u1", "|V24" (user data)
    int dimensions;  ///< 1 to 3
    int64_t shape[3];
    int64_t stride_bytes[3];
};

/// What went wrong in the last call of this thread that failed. Valid until the next one.
char const* pogosim_host_error(void);

/// POGOSIM_VERSION_STRING of the simulator.
char const* pogosim_host_version(void);

/// What this library was built of and with, a line each: "name: value". The names are
///  - commit: of the sources, as `git describe --always --tags --dirty` says; "unknown" if nothing told the build, or
///    libpogosim.commit is not beside the library,
///  - compiler: that of C++, with its version,
///  - engines: the values of `physics_engine`, separated by ", "; that of another library with its version,
///  - Arrow: the version of Apache Arrow that its module of tables was built with.
/// Later versions may have further lines. Programs print them when they are called with --version.
char const* pogosim_build_info(void);

/// Builds the world and runs the program up to time 0: main(), callbacks, user_init. `run` is NULL on failure.
int pogosim_run_open(struct pogosim_run_options const* options, pogosim_run** run);

/// Up to `steps` steps, but no further step after `budget_s` seconds of wall-clock time. `done`: how many were made.
int pogosim_run_step(pogosim_run* run, int64_t steps, double budget_s, int64_t* done);

/// Ends the run: last callbacks, complete files. Does nothing the second time.
int pogosim_run_end(pogosim_run* run);

/// Its end will leave the archive of flash memory as it is.
void pogosim_run_leave_archive(pogosim_run* run);

/// Ends the run, if it has not ended, and frees it. NULL does nothing.
void pogosim_run_close(pogosim_run* run);

/// A number: "time" (s), "step", "step_count" (steps of the whole run), "time_step" (s), "is_over" (1: no further step
/// will be made), "has_failed" (1: a step has failed), "seed", "object_count", "robot_count", "lamp_count",
/// "link_count", "part_count" (bodies of which membranes are made), "user_data_bytes", "save_time" (s, of the last save
/// of rows; NaN before the first).
int pogosim_run_number(pogosim_run const* run, char const* name, double* value);

/// An array. Arrays of bodies (rows: bodies): "bodies.position" (n, 2) mm, "bodies.heading" (n) rad, not wrapped,
/// "bodies.velocity" (n, 2) mm/s and "bodies.angular_velocity" (n) rad/s, of the displacement and the turn in the last
/// step, "bodies.radius" (n) mm. Arrays of robots (rows: objects that a program, a
/// host or a script drives): "robots.id", "robots.category" (index into pogosim_run_categories), "robots.body" (index
/// of its body; 2^32 - 1: none), "robots.led" (n, 5, 3), "robots.ticks", "robots.clock" (us; at least 2^62: switched
/// off), "robots.messages_sent", "robots.messages_received", "robots.magnetometer" (n, 3), counts read last,
/// "robots.magnetometer_samples" (n), how often it was read, "robots.user_data", zero for those that do not run the
/// program. Light on the floor: "light" (rows, columns), sensor counts. Columns that the program has added to the data
/// file, by robot, as set by data_set_value_* at the last save: "columns.NAME", and "columns_absent.NAME", true for
/// robots that set no value or wrote no row; for them "columns.NAME" has NaN, 0 or false. A column of strings has the
/// type "text": UTF-8, each ended by a zero, so many bytes; it stays in place only until this thread asks for the next
/// one.
int pogosim_run_array(pogosim_run const* run, char const* name, struct pogosim_array* array);

/// An array of the robots of one category whose configuration says `brain: host`: the run's robots are driven by what
/// is in it. Rows: the robots of the category (n), in the order of pogosim_run_array(). Addresses stay the same as long
/// as the run. Robots take and give values at their own ticks, every 16 ms; no thread may write while another steps.
///
/// To be written between steps: "motors" (n, 3) <i4, powers of the right, the left and the back motor, -1023 to 1023,
/// positive is forward; "leds" (n, 5, 3) |u1; "send_bytes" (n, 382) |u1, "send_length" (n) <i4, negative for no
/// message, set back to -1 once it is sent, and "send_face" (n) |i1, 0 front, 1 right, 2 back, 3 left, -1 all.
///
/// To be read: "photosensors" (n, 3) <i2, back, front left, front right, -1 without a body; "acceleration" (n, 3) <f4
/// and "angular_velocity" (n, 3) <f4, as of pogobot_imu_read(); "battery_mv" (n) <i2; "received_count" (n) <u4.
/// "received" (m, 5) <i4 has one row per message received so far: robot (row), sender, face that received it, length
/// of its payload in bytes, and offset of that in "received_bytes" (k) |u1.
int pogosim_run_brain_array(pogosim_run* run, char const* category, char const* name, struct pogosim_array* array);

/// Copies `size` bytes at an address in the memory of each robot that runs a firmware, by the name of its file. `bytes`
/// has room for as many times `size` as the run has robots, and `runs_it` for as many bytes: 1 for those that run it, 0
/// for all others, whose bytes stay as they are. It fails where these have no memory.
int pogosim_run_firmware_bytes(pogosim_run const* run, char const* firmware, uint32_t address, uint32_t size,
                               void* bytes, uint8_t* runs_it);

/// Forgets the received messages of such a category: "received" is empty, and "received_count" 0. Without it, messages
/// wait in the robots' mailboxes once there are as many as these hold, and are lost when these are full.
int pogosim_run_clear_received(pogosim_run* run, char const* category);

/// Names of the categories, a line each. Valid as long as the run.
char const* pogosim_run_categories(pogosim_run const* run);

/// Names of the columns that the program has added to the data file, a line each. Valid as long as the run.
char const* pogosim_run_columns(pogosim_run const* run);

/// What the metadata of a data file say of the run, whether it writes one or not: a JSON object of texts, such as
/// "resolved_configuration", "objects" and "arena_polygons". Valid as long as the run.
char const* pogosim_run_metadata(pogosim_run const* run);

/// Messages since the last call, a line each, the first character says of what kind: 'D' debug, 'I' information, 'W'
/// warning, 'E' error, 'P' printed by the program. Valid until the next call for this run.
char const* pogosim_run_messages(pogosim_run* run);

/// Draws the world, as the configuration wants pictures (window_width and window_height apart). `rgb`: height_px x
/// width_px x 3 bytes, row by row from the top left. Needs no display.
int pogosim_run_draw(pogosim_run* run, int32_t width_px, int32_t height_px, uint8_t* rgb);

/// What a picture shows of a run, all of one moment. The host gives the memory; a NULL is left out.
struct pogosim_view {
    double time_s;       ///< simulated time
    int64_t step;        ///< time steps since the beginning
    float* poses;        ///< shape (objects, 3): x and y, mm; heading, rad, NaN of membranes
    uint32_t* led_rgb;   ///< shape (objects): head LED, 0xRRGGBB; 2^32 - 1 for what runs no program
    float* parts_mm;     ///< shape (parts, 2): x and y of the bodies of membranes, object by object
    uint32_t* parts_of;  ///< shape (parts): index of the object that each belongs to
};

/// Looks at a run between two time steps.
int pogosim_run_look(pogosim_run const* run, struct pogosim_view* view);

/// Moves the body of a robot to another pose, at rest. mm and rad.
int pogosim_run_set_pose(pogosim_run* run, size_t robot, double x_mm, double y_mm, double heading_rad);

/// An object, which has a body or runs the program; in the order of the rows of the data file.
struct pogosim_object {
    uint32_t id;        ///< robot_id in the data file
    uint32_t category;  ///< index into pogosim_run_categories
    uint32_t robot;     ///< row in arrays of robots; 2^32 - 1: runs no program
    int32_t is_alive;   ///< 0: switched off
    double x_mm;        ///< of a membrane, its middle; in a periodic arena, inside its box
    double y_mm;
    double heading_rad;  ///< -pi to pi; 0 for what has no body of its own
    double light;        ///< sensor counts, without noise
};

/// A lamp, in the order of the configuration.
struct pogosim_lamp {
    char const* category;  ///< valid as long as the run; ignored when a lamp is set
    int32_t is_on;         ///< 0: dark, whatever the configuration says
    double intensity;      ///< factor for the levels of the configuration; at least 0
    double x_mm;           ///< where it stands; of one on an orbit, the centre of the orbit
    double y_mm;
};

/// The present state of an object. `object`: from 0 to the number "object_count" - 1.
int pogosim_run_object(pogosim_run const* run, size_t object, struct pogosim_object* found);

/// Puts an object elsewhere, at rest. mm and rad.
int pogosim_run_set_object_pose(pogosim_run* run, size_t object, double x_mm, double y_mm, double heading_rad);

/// Moves an object as a user's hand does: towards a point, mm, as far as walls leave it room. It stands still there
/// until its motors or others move it. `is_moved`: 0: it stays where it is. The metadata of the data file tell it.
int pogosim_run_drag_object(pogosim_run* run, size_t object, double x_mm, double y_mm, int* is_moved);

/// Switches an object that runs the program off (0) or on, see pogosim_world_set_alive() in world.h.
int pogosim_run_set_alive(pogosim_run* run, size_t object, int alive);

/// What a lamp is like now. `lamp`: from 0 to the number "lamp_count" - 1.
int pogosim_run_lamp(pogosim_run const* run, size_t lamp, struct pogosim_lamp* found);

/// Switches, dims and moves a lamp. The light on the floor is updated at once.
int pogosim_run_set_lamp(pogosim_run* run, size_t lamp, struct pogosim_lamp const* setting);

/// What links do: values of `kind`.
enum pogosim_run_link_kind {
    POGOSIM_RUN_SPRING = 0,
    POGOSIM_RUN_ROD = 1,
    POGOSIM_RUN_HINGE = 2,
};

/// A link between an object and another one, or a place in the arena.
struct pogosim_run_link {
    int32_t kind;
    int32_t a;             ///< an object
    int32_t b;             ///< another one; -1: the arena
    int32_t robot_a;       ///< row of `a` in arrays of robots; -1: it runs no program; ignored when a link is made
    int32_t robot_b;       ///< that of `b`, likewise
    int32_t is_cut;        ///< not 0: it does nothing any more; ignored when a link is made
    double end_a_mm[2];    ///< from the centre of its object, ahead and to its right
    double end_b_mm[2];    ///< the same; in the arena, a place
    double rest_mm;        ///< length at rest; made with NaN: as far apart as its ends are
    double stiffness_n_m;  ///< of a spring, 0 or more
    double damping_n_s_m;  ///< of a spring, 0 or more
    double breaking_n;     ///< above 0, may be infinite
    double least_rad;      ///< of a hinge, at most 0, may be infinite
    double most_rad;       ///< of a hinge, at least 0, may be infinite
    double length_mm;      ///< distance of its ends now; ignored when a link is made
    double tension_n;  ///< force in the last step, positive when it pulls; of a hinge, its magnitude; ignored likewise
};

/// The links, those that are cut included, up to `room` of them. `count`: how many there are.
int pogosim_run_links(pogosim_run const* run, struct pogosim_run_link* links, size_t room, size_t* count);

/// What to fill in for a new link: its ends are the centres of its objects, of a hinge the place halfway between them;
/// without stiffness, damping and limits. `b`: -1: the arena, where `a` is.
int pogosim_run_new_link(pogosim_run const* run, int32_t kind, size_t a, int64_t b, struct pogosim_run_link* link);

/// Makes a link. `index`: from now on.
int pogosim_run_add_link(pogosim_run* run, struct pogosim_run_link const* link, size_t* index);

/// Cuts links, for good; none if there is none of one of these indices.
int pogosim_run_cut_links(pogosim_run* run, uint32_t const* links, size_t count);

/// Sets a column that the program has declared: its value in all rows of an object from now on, unless the program's
/// callback_export_data sets another one. `object`: negative for all objects.
int pogosim_run_set_column(pogosim_run* run, int64_t object, char const* name, double value);

/// Gives the global variable that the program has set from `parameters.NAME` another value, written in YAML.
int pogosim_run_set_parameter(pogosim_run* run, char const* name, char const* value);

/// Light level at each robot, sensor counts: the mean of its three sensors, without noise; -1 if it has no body.
/// `levels` has a place for each.
void pogosim_run_light_levels(pogosim_run const* run, double* levels);

/// A hash of poses, links, LEDs, light, controllers and random streams, and of how many messages wait; not of their
/// contents, nor of user data. Equal for runs in the same state.
uint64_t pogosim_run_hash(pogosim_run const* run);

/// Brings the data file up to date.
int pogosim_run_save(pogosim_run* run);

/// Copies the state of a run between two steps: world, physics, random streams, and the program's variables and stacks.
/// Fails for a run that writes a data file, a log of messages or pictures, whose rows would go back in time, for one
/// that moves bodies with Box2D, and for a program that allocates memory or uses a library with a state of its own.
/// `state` is NULL on failure.
int pogosim_run_save_state(pogosim_run* run, pogosim_state** state);

/// Goes on from a state of this run: what follows is what followed then. Arrays stay where they are.
int pogosim_run_restore_state(pogosim_run* run, pogosim_state const* state);

/// Gives the memory of a state back, also after pogosim_run_close().
void pogosim_state_free(pogosim_state* state);

/// What a run is to do, and has done.
struct pogosim_turn {
    int64_t left;          ///< steps to make; those that were made are taken off
    int32_t status;        ///< as of pogosim_run_step(); pogosim_threads_step() steps a run while it is POGOSIM_OK
    int32_t has_messages;  ///< not 0: pogosim_run_messages() has some
};

/// Makes the steps that are left, as pogosim_run_step(), and says what a host needs to know afterwards. Returns its
/// status: POGOSIM_OVER, too, if the run was over before; without steps to make, POGOSIM_OK unless it is over or has
/// failed.
int pogosim_run_take_turn(pogosim_run* run, struct pogosim_turn* turn, double budget_s);

/// Makes `count` threads, 1 to 1024, which wait for work; fewer if the system cannot make so many.
int pogosim_threads_open(int count, pogosim_threads** threads);

/// An array of pogosim_run_brain_array() that runs exchange with the host's memory while they take a turn.
struct pogosim_exchange {
    char const* category;  ///< of robots with `brain: host`
    char const* name;      ///< of the array
    void* place;           ///< of the array of the first run; those of the others follow without gaps
    size_t bytes_each;     ///< size of the array of one run; a run whose array has another one fails
    int32_t gives;         ///< not 0: before its steps, the run gets what is there; only arrays that can be written
    int32_t takes;         ///< not 0: after its steps, what it has is copied there
};

/// Many runs make the steps that are left, as many at a time as there are threads, each by pogosim_run_step(). No run
/// begins a further step after `budget_s` seconds (infinity: no limit), but each makes at least one. Before and after
/// its steps, also if there are none, each run exchanges these arrays. The call fails with the first run that fails in
/// it; the others go on nevertheless. A run may be given only once.
int pogosim_threads_step(pogosim_threads* threads, pogosim_run* const* runs, struct pogosim_turn* turns, size_t count,
                         struct pogosim_exchange const* exchanges, size_t exchange_count, double budget_s);

/// What went wrong in the last call for the run of this index; empty: nothing.
char const* pogosim_threads_error(pogosim_threads const* threads, size_t run);

/// Ends the threads. The runs stay open. NULL does nothing.
void pogosim_threads_close(pogosim_threads* threads);

/// Reads an expression, as breakpoints of the window have it; `known`: the names of values that may be in it, a line
/// for each. It fails where the text is wrong, and says at which character.
int pogosim_expression_open(char const* text, char const* known, pogosim_expression** expression);

/// The names in it, each once, a line for each; empty: there is none.
char const* pogosim_expression_names(pogosim_expression const* expression);

/// What it is for each of `count` robots; truth values are 1 and 0. `values`: of each of its names, in their order,
/// `count` numbers, NaN where there is none.
void pogosim_expression_numbers(pogosim_expression const* expression, float const* const* values, size_t count,
                                float* numbers);

/// NULL does nothing.
void pogosim_expression_close(pogosim_expression* expression);

/// Copies an array of many runs, one after the other: that of pogosim_run_array(), or, if `category` is not NULL, of
/// pogosim_run_brain_array(). Arrays of bodies ("bodies.position") have a row for each robot in place of one for each
/// body, NaN for robots without one; "light_levels" are those of pogosim_run_light_levels(), and numbers of
/// pogosim_run_number() are one double each. `bytes_each`: size of the array of one run; it fails where that is another
/// one.
int pogosim_runs_read(pogosim_run* const* runs, size_t count, char const* category, char const* name, void* into,
                      size_t bytes_each);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif

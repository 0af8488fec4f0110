// Everything a configuration file says, typed and checked. Defaults stand here and in the structs of world/specs.hpp,
// geometry/shape.hpp and geometry/formation.hpp; the tables in *_keys.cpp bind them to their YAML keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/link_config.hpp"
#include "config/magnetometer_config.hpp"
#include "config/reading.hpp"
#include "geometry/formation.hpp"
#include "world/specs.hpp"
#include "world/view_options.hpp"

namespace pogosim {

struct ConfigSource;
class ObjectTypes;
class Problems;

enum class BoundaryCondition { solid, periodic };
enum class LogFormat { dated, minimal };
/// Which copies of a message that a wall or a membrane sends arrive.
enum class WallCopies { one_per_face, original };
/// When rows are recorded: at the first step at or after each multiple of the period, or as in the original simulator,
/// see sim/due_times.hpp.
enum class RowTiming { multiples, original };

/// Largest length and coordinate, mm. A float still tells 0.06 mm apart there.
inline constexpr double kMaxLength = 1.0e6;

/// More objects than fit into the memory of most machines.
inline constexpr int kMaxObjects = 10'000'000;

/// What pictures and films of a data file draw of a lamp, since they know its keys only.
enum class DrawnAs {
    nothing,  // a note says that its light is not drawn
    spot,     // the light that the keys of static_light and orbiting_static_light describe
    beam,     // a note says that its beams are not drawn
};

/// How the objects of an entry are placed separately from other entries.
struct OwnFormation {
    std::optional<std::string> name{};  // absent: that of the top level
    std::optional<Polygon> area_mm{};   // absent: the arena

    bool is_given() const { return name || area_mm; }
};

/// One entry of `objects`.
struct ObjectConfig {
    std::string category;             // its name in the configuration
    std::string type;                 // lower case, "pogobot"
    int nb = 1;                       // how many
    std::optional<Vec2> position_mm;  // both x and y given: all stand there
    float heading_rad = 0.0F;         // with position_mm
    std::vector<Placement> poses;     // one for each object, instead of position_mm
    OwnFormation own_formation;       // without position_mm and poses a formation places those with a body: this one
    ObjectSpec spec;                  // what the type makes them of
    DrawnAs drawn_as = DrawnAs::nothing;  // of a lamp
    std::string line;                     // where it is written, "conf/a.yaml:14", for messages
    std::optional<std::size_t> item{};    // the category is a list of entries, and this one has the place, from 0
};

/// Where the objects of the entry start, one pose for each; empty when the configuration does not say.
std::vector<Placement> given_poses(ObjectConfig const& object);

/// Pixels of a side of a picture, and so of the window.
inline constexpr int kMostPixels = 16384;

/// Window and pictures.
/// The window, frames and films, and what they show.
struct ViewConfig : ViewOptions {
    bool gui = true;
    int window_width_px = 800;
    int window_height_px = 800;
    double gui_speed_up = 1.0;  // simulated seconds per second of wall clock; 0: no limit
    double mm_to_pixels = 1.0;
    bool show_communication_channels = false;  // older keys for `links`
    bool show_communication_channels_above_all = false;
    double save_video_period_s = -1.0;  // <= 0: no frames
    std::string frames_name = "frames/f{:010.4f}.png";
    bool delete_old_files = false;
};

/// Data file, message log and console file.
struct OutputConfig {
    bool enable_data_logging = true;
    std::string data_filename = "data.feather";
    double save_data_period_s = 1.0;  // <= 0: only the rows of time 0
    RowTiming row_timing = RowTiming::multiples;
    std::optional<std::vector<std::string>> fields;      // data_logger_fields; absent: all columns
    std::optional<std::vector<std::string>> categories;  // data_logger_category; absent: all categories
    std::int64_t flush_row_count = 65536;                // rows per record batch
    bool led_column = false;                             // data_logger_led: adds led_rgb, the head LED as 0xRRGGBB
    std::string message_log;                             // file; empty: none
    bool enable_console_logging = false;
    std::string console_filename = "console.txt";
    LogFormat log_format = LogFormat::dated;
};

/// Threads of a run.
inline constexpr int kMostThreads = 256;

/// Variables of the program outside USERDATA.
enum class RobotMemoryKind {
    automatic,  // own for programs written for the robots' SDK, else shared
    shared,     // one for all robots
    own,        // each robot has its own
};

/// `flash_state`: archives that keep the flash memory of robots from one run to the next.
struct FlashStateConfig {
    std::string input_file;   // empty: robots start with blank flash memory
    std::string output_file;  // empty: it is lost with the run
    bool create_if_missing = true;
};

struct Scenario {
    std::filesystem::path file;                       // the configuration; relative names are also looked for beside it
    std::string arena_file;                           // needed
    std::optional<double> arena_surface_mm2 = 1.0e6;  // absent: the arena file is in mm
    bool arena_stretch = false;
    BoundaryCondition boundary = BoundaryCondition::solid;
    WallSpec walls;
    bool ignore_occlusions = false;
    WallCopies wall_copies = WallCopies::one_per_face;
    double arena_temperature_c = 42.0;
    double simulation_time_s = 100.0;
    double time_step_s = 0.01;
    std::string physics_engine = "auto";  // one of physics_engine_names()
    std::optional<int> threads = 1;       // absent: as many as the number of objects is worth
    std::optional<std::uint32_t> seed;    // absent: drawn from the system
    double user_code_timeout_s = 10.0;    // processor time one call of user code may take; 0: no limit
    int robot_stack_kib = 8192;           // of the stack of each robot that waits in the middle of its program
    std::int64_t coroutine_stack_bytes = 8192 * 1024;  // the same as written; robot_stack_kib is what counts
    RobotMemoryKind robot_memory = RobotMemoryKind::automatic;
    std::optional<FlashWrites> flash;  // of categories that do not say; absent: overwrite
    FlashStateConfig flash_state;
    int light_map_columns = 100;
    int light_map_rows = 100;
    FormationSpec formation;
    MagnetometerConfig magnetometer;
    ViewConfig view;
    OutputConfig output;
    std::vector<ObjectConfig> objects;           // in the order of the file
    std::vector<LinkConfig> links;               // the same
    std::vector<ObjectFile> object_files;        // robot models and scripts of these
    std::shared_ptr<ConfigSource const> source;  // what was written; null for one put together in code
};

struct LoadOptions {
    std::vector<std::string> overrides{};  // --set, in order
    bool strict = false;                   // unknown keys are errors
    bool strict_values = false;            // values that would be cut, or replaced by the default, are errors
    bool thorough = false;                 // for a check, see Reading
    std::string firmware{};                // that drives robots in the place of the program; empty: none does
    bool strict_overrides = false;         // unknown keys of overrides are errors, even if others are not

    bool operator==(LoadOptions const&) const = default;
};

/// Reads, resolves, checks. Throws ConfigError with "file:line: key.path: expected ..., found ...", a line for each
/// mistake; warns once for each unknown key, naming the nearest known one. `types`: those that objects may have, see
/// lamps/lamp_types.hpp.
Scenario load_scenario(std::string const& path, LoadOptions const& options, ObjectTypes const& types);

/// The same, but adds the mistakes to `problems`: what the scenario says is right where they are not. Throws
/// ConfigError for a file that cannot be read as a map of keys.
Scenario read_scenario(std::string const& path, LoadOptions const& options, ObjectTypes const& types,
                       Problems& problems);

}  // namespace pogosim

// Initial formations: where the objects stand at time 0. Adding one is one function and one line of the table in
// formation.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "geometry/arena.hpp"
#include "geometry/formations/heading_column.hpp"
#include "geometry/obstacle.hpp"

namespace pogosim {

/// Rows of an imported file, counted within its first instant, that belong to objects which are placed at another time.
struct RowsOfOthers {
    std::size_t first = 0;
    std::size_t count = 0;
    bool may_follow = false;  // those after the rows used may be of others, too, so too many are no warning
};

/// How many objects of a category a formation places.
struct CategoryCount {
    std::string category;
    std::size_t count = 0;
};

/// How the nodes of a lattice are arranged: six neighbours each, or four.
enum class LatticeKind { triangular, square };

/// The keys `initial_formation*`, `formation_*`, `chessboard_*`, `lattice_*` and `imported_*` of a configuration.
struct FormationSpec {
    std::string name = "power_lloyd";
    std::string root_object = "arena";  // category whose contour bounds the formation; "", "null" or "arena": the arena
    Vec2 centre_mm{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};
    float min_space_mm = 0.0F;                                    // lower bound of every placement radius
    float max_space_mm = std::numeric_limits<float>::infinity();  // random: a new point is this near some placed one
    int attempts_per_point = 100;                                 // consecutive rejections before starting again
    int max_restarts = 100;                                       // restarts before giving up
    float chessboard_pitch_mm = 100.0F;
    bool cluster_at_centre = true;  // chessboard: rings around the centre; false: spread over the bounding box
    LatticeKind lattice_kind = LatticeKind::triangular;
    std::optional<float> lattice_spacing_mm{};  // between neighbours; absent: lattice_spacing_of()
    std::string filename;                       // imported: csv or feather
    std::optional<double> time_s = 0.0;         // imported: of the rows; 0: the first of the file; absent: the last
    RowsOfOthers rows_of_others{};              // imported
    std::vector<CategoryCount> categories{};    // imported: of all objects that get a row, in their order
    std::vector<std::string> placed_apart{};    // imported: categories that get none
    Vec2 imported_min{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};
    Vec2 imported_max{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};
};

struct Placement {
    Vec2 position_mm;
    float heading_rad = 0.0F;
};

/// Where a formation may place objects.
struct FormationGround {
    Arena const& domain;
    std::span<Obstacle const> obstacles{};              // that stand there already
    std::string_view name = "arena";                    // of the domain, for messages
    std::string_view remedy = "enlarge arena_surface";  // when there is no room
    bool periodic = false;                              // all of the bounding box is inside
};

/// One row of a file for the formation `imported`.
struct ImportedPose {
    double x = 0.0;  // mm, or in the unit of imported_min and imported_max
    double y = 0.0;
    double heading_rad = std::numeric_limits<double>::quiet_NaN();  // NaN: not given, drawn at random
    double time_s = 0.0;                                            // only the rows of one time count
    std::size_t row = 0;                                            // line of a csv file, row of a table; for messages
    std::shared_ptr<std::string const> category{};                  // in a data file of a run; its rows share it
    bool is_part = false;                                           // a dot of a membrane
};

/// Names that many rows share.
class SharedNames {
public:
    /// The name, the same object for equal ones.
    std::shared_ptr<std::string const> shared(std::string const& name) {
        if (!last_ || *last_ != name) {
            auto& known = names_[name];
            if (!known) {
                known = std::make_shared<std::string const>(name);
            }
            last_ = known;
        }
        return last_;
    }

private:
    std::map<std::string, std::shared_ptr<std::string const>> names_;
    std::shared_ptr<std::string const> last_;
};

/// A file for the formation `imported`.
struct ImportedPoses {
    std::vector<ImportedPose> rows;
    ImportRemark remark{};
};

/// Objects do not fit, or a value of the spec makes no sense. The message starts with the key of the configuration.
class FormationError : public ConfigError {
public:
    FormationError(std::string key, std::string const& message)
        : ConfigError(key + ": " + message), key_(std::move(key)) {}

    std::string const& key() const { return key_; }

private:
    std::string key_;
};

constexpr char const* kFormationKey = "initial_formation";

/// The formation that reads a file.
constexpr char const* kImportedFormation = "imported";

/// Reads all poses of a file that is not text. Its mistakes are ConfigErrors.
using PoseReader = std::function<ImportedPoses(std::filesystem::path const&)>;

/// Distance between neighbours of a lattice of objects of these radii: that of the spec, or as near as a formation puts
/// the two largest ones to each other.
float lattice_spacing_of(FormationSpec const& spec, std::span<float const> radii_mm);

/// Whether a formation of this name is a lattice.
bool is_lattice(std::string_view name);

/// Names of all formations, in the table's order.
std::span<std::string const> formation_names();

/// One pose for each object of the given radii (mm, finite, >= 0), in the same order. Placement radius of object i: r_i
/// = 1.01 max(radius, min_space). Every object but the imported ones stands inside the domain, at least r_i from its
/// walls and from every obstacle, and at least r_i + r_j from object j; imported ones stand where the file says, which
/// must be inside. Obstacles that are not in the domain change nothing. `read_feather` reads the file of `imported`
/// when its name ends in ".feather". Headings: pi/2 for aligned_*, the file's for imported, otherwise uniform in (-pi,
/// pi]. Throws FormationError when they do not fit, after a bounded search ("initial_formation: 'disk' has places for
/// 31 of 40 objects (largest radius 26.5 mm) in this arena. ..."); when a value of the spec makes no sense; or when the
/// name is unknown. Throws ConfigError when the imported file is unreadable or too short. The same arguments give the
/// same poses.
std::vector<Placement> place(FormationSpec const& spec, std::span<float const> radii_mm, FormationGround const& ground,
                             RandomStream& random, PoseReader const& read_feather = {});

}  // namespace pogosim

#include "light/light_blockers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/polygon.hpp"
#include "geometry/shape.hpp"
#include "light/lit_area.hpp"

namespace pogosim {

namespace {

struct Point {
    double x;
    double y;
};

Point point(Vec2 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

double cross(Point a, Point b) {
    return a.x * b.y - a.y * b.x;
}

/// Cells of one row, `first` to `last`, that half-planes leave over. Bounds that two areas share are computed alike, so
/// that no cell is on both sides or on none.
class RowPart {
public:
    RowPart(ImageRange columns, double first_x_mm, double cell_mm)
        : first_(columns.first), last_(columns.last), first_x_mm_(first_x_mm), cell_mm_(cell_mm) {}

    /// Keeps the cells at x with slope * x >= bound; if it is strict, those above it.
    void keep(double slope, double bound, bool strict) {
        if (slope == 0.0) {
            if (strict ? bound >= 0.0 : bound > 0.0) {
                last_ = first_ - 1;
            }
            return;
        }
        double const low = static_cast<double>(first_) - 1.0;
        double const high = static_cast<double>(last_) + 1.0;
        double const column = std::clamp((bound / slope - first_x_mm_) / cell_mm_, low, high);
        if (slope > 0.0) {
            first_ = std::max(first_, static_cast<std::int64_t>(strict ? std::floor(column) + 1.0 : std::ceil(column)));
        } else {
            last_ = std::min(last_, static_cast<std::int64_t>(strict ? std::ceil(column) - 1.0 : std::floor(column)));
        }
    }

    std::int64_t first() const { return first_; }
    std::int64_t last() const { return last_; }
    double x_mm(std::int64_t column) const { return first_x_mm_ + static_cast<double>(column) * cell_mm_; }

private:
    std::int64_t first_;
    std::int64_t last_;
    double first_x_mm_;  // of column 0
    double cell_mm_;
};

/// The centres of the cells of a map as seen from a point; in a periodic map, the nearest image of each.
class CellsAround {
public:
    CellsAround(LightMap const& map, Vec2 source_mm) : map_(map), cell_mm_(point(map.cell_mm)) {
        Vec2 const source = source_mm - map.origin_mm;
        first_mm_ = {0.5 * cell_mm_.x - static_cast<double>(source.x),
                     0.5 * cell_mm_.y - static_cast<double>(source.y)};
        columns_ = {0, map.columns - 1};
        rows_ = {0, map.rows - 1};
        if (map.periodic) {
            constexpr float kFar = 0x1p31F;
            columns_ = images_between(-kFar, kFar, source.x / map.cell_mm.x, map.columns);
            rows_ = images_between(-kFar, kFar, source.y / map.cell_mm.y, map.rows);
        }
    }

    /// Calls visit(cell, its centre) for the cells that an edge hides: those between the lines through its ends,
    /// beyond it.
    template <class Visit>
    void behind_edge(Point a, Point b, Visit const& visit) const {
        if (cross(a, b) < 0.0) {
            std::swap(a, b);
        }
        if (cross(a, b) == 0.0) {
            return;
        }
        Point const along{b.x - a.x, b.y - a.y};
        double const lowest = a.y > 0.0 && b.y > 0.0 ? std::min(a.y, b.y) : -kFar;
        double const highest = a.y < 0.0 && b.y < 0.0 ? std::max(a.y, b.y) : kFar;
        for_each_row(
            lowest, highest,
            [&](double y, RowPart& part) {
                keep_between(a, b, y, part);
                part.keep(along.y, along.x * (y - a.y) + along.y * a.x, /*strict=*/true);
            },
            visit);
    }

    /// The same for a disk around another place; it leaves the cells in it, and those within a margin around it.
    template <class Visit>
    void behind_disk(Point middle, double radius_mm, double margin_mm, Visit const& visit) const {
        double const squared_distance = middle.x * middle.x + middle.y * middle.y;
        double const squared_length = squared_distance - radius_mm * radius_mm;
        if (squared_length <= 0.0) {
            return;
        }
        double const length = std::sqrt(squared_length);
        Point const a{middle.x * length + middle.y * radius_mm, middle.y * length - middle.x * radius_mm};
        Point const b{middle.x * length - middle.y * radius_mm, middle.y * length + middle.x * radius_mm};
        double const clear_mm = radius_mm + margin_mm;
        for_each_row(
            -kFar, kFar,
            [&](double y, RowPart& part) {
                keep_between(a, b, y, part);
                part.keep(middle.x, squared_length - middle.y * y, /*strict=*/true);
            },
            [&](std::uint32_t cell, Point centre) {
                double const x = centre.x - middle.x;
                double const y = centre.y - middle.y;
                if (x * x + y * y >= clear_mm * clear_mm) {
                    visit(cell, centre);
                }
            });
    }

private:
    static constexpr double kFar = std::numeric_limits<double>::max();

    /// Keeps the cells between two directions, the second one less than half a turn counterclockwise of the first.
    static void keep_between(Point a, Point b, double y, RowPart& part) {
        part.keep(-a.y, -(a.x * y), /*strict=*/false);
        part.keep(b.y, b.x * y, /*strict=*/true);
    }

    template <class Keep, class Visit>
    void for_each_row(double lowest_mm, double highest_mm, Keep const& keep, Visit const& visit) const {
        for (std::int64_t row = rows_.first; row <= rows_.last; ++row) {
            double const y = first_mm_.y + static_cast<double>(row) * cell_mm_.y;
            if (y < lowest_mm || y > highest_mm) {
                continue;
            }
            RowPart part(columns_, first_mm_.x, cell_mm_.x);
            keep(y, part);
            std::uint32_t const row_start = ImageRange::cell(row, map_.rows) * static_cast<std::uint32_t>(map_.columns);
            for (std::int64_t column = part.first(); column <= part.last(); ++column) {
                visit(row_start + ImageRange::cell(column, map_.columns), Point{part.x_mm(column), y});
            }
        }
    }

    LightMap const& map_;
    Point cell_mm_;
    Point first_mm_{};  // the centre of the first cell
    ImageRange columns_{};
    ImageRange rows_{};
};

}  // namespace

/// The cells that are hidden from one point.
class LightBlockers::Hidden {
public:
    /// Adds to `cells`.
    Hidden(LightMap const& map, Vec2 source_mm, Space& space, std::vector<std::uint32_t>& cells)
        : around_(map, source_mm), margin_mm_(0.5F * length(map.cell_mm)), space_(space), cells_(cells) {
        space_.is_hidden.resize(map.level.size(), 0);
        space_.crossings.resize(map.level.size(), 0);
        for (std::uint32_t const cell : cells_) {
            space_.is_hidden[cell] = 1;
        }
    }
    Hidden(Hidden const&) = delete;
    Hidden& operator=(Hidden const&) = delete;
    ~Hidden() {
        for (std::uint32_t const cell : cells_) {
            space_.is_hidden[cell] = 0;
        }
    }

    void behind_edge(Vec2 a, Vec2 b) {
        around_.behind_edge(point(a), point(b), [&](std::uint32_t cell, Point) { add(cell); });
    }

    void behind_disk(Vec2 middle, float radius_mm, bool has_sensors) {
        around_.behind_disk(point(middle), static_cast<double>(radius_mm),
                            has_sensors ? static_cast<double>(margin_mm_) : 0.0,
                            [&](std::uint32_t cell, Point) { add(cell); });
    }

    /// What is behind closed lines: where the line of sight crosses them at least twice, and `hides` agrees.
    template <class Hides>
    void behind_outlines(std::span<Polygon const> outlines, Hides const& hides) {
        space_.touched.clear();
        space_.once.clear();
        for (Polygon const& outline : outlines) {
            Vec2 from = outline.back();
            for (Vec2 const to : outline) {
                around_.behind_edge(point(from), point(to), [&](std::uint32_t cell, Point centre) {
                    std::uint16_t& crossings = space_.crossings[cell];
                    if (++crossings == 2) {
                        space_.touched.push_back({cell, centre.x, centre.y});
                    } else if (crossings == 1) {
                        space_.once.push_back(cell);
                    }
                });
                from = to;
            }
        }
        for (Touched const& at : space_.touched) {
            if (hides(Point{at.x_mm, at.y_mm}, space_.crossings[at.cell])) {
                add(at.cell);
            }
        }
        for (std::uint32_t const cell : space_.once) {
            space_.crossings[cell] = 0;
        }
    }

    /// Cells this near to a sensor may give it its light.
    float margin_mm() const { return margin_mm_; }

private:
    void add(std::uint32_t cell) {
        if (space_.is_hidden[cell] == 0) {
            space_.is_hidden[cell] = 1;
            cells_.push_back(cell);
        }
    }

    CellsAround around_;
    float margin_mm_;
    Space& space_;
    std::vector<std::uint32_t>& cells_;
};

void LightBlockers::start(World const& world) {
    body_count_ = world.bodies.spec.size();
    blockers_ = blockers_of(world, &BodySpec::blocks_light);
    has_sensors_.assign(body_count_, false);
    for (std::uint32_t robot = 0; robot < world.robots.body.size(); ++robot) {
        if (world.robots.body[robot] < body_count_) {
            has_sensors_[world.robots.body[robot]] = !world.spec_of(robot).model.light_sensors.empty();
        }
    }
}

bool LightBlockers::update(World const& world) {
    bool has_changed = false;
    if (!has_started_ || body_count_ != world.bodies.spec.size()) {
        start(world);
        poses_.resize(blockers_.size());
        has_started_ = true;
        has_changed = true;
    }
    for (std::size_t i = 0; i < blockers_.size(); ++i) {
        BlockerPose const pose = pose_of(world, blockers_[i]);
        has_changed = has_changed || pose != poses_[i];
        poses_[i] = pose;
    }
    return has_changed;
}

std::size_t LightBlockers::end_of_body(std::size_t first) const {
    std::size_t last = first + 1;
    while (last < blockers_.size() && blockers_[first].next_body == kNone &&
           blockers_[last].body == blockers_[first].body) {
        ++last;
    }
    return last;
}

/// Blockers from `first` on are all parts of a body.
void LightBlockers::add_shadow(std::size_t first, Vec2 offset_mm, Hidden& hidden) {
    Blocker const& blocker = blockers_[first];
    BlockerPose const& pose = poses_[first];
    bool const has_sensors = has_sensors_[blocker.body];
    if (blocker.next_body != kNone) {
        hidden.behind_edge(offset_mm - pose.axis, offset_mm + pose.axis);
        return;
    }
    if (blocker.corners.empty()) {
        hidden.behind_disk(offset_mm, pose.radius_mm, has_sensors);
        return;
    }
    std::size_t const count = end_of_body(first) - first;
    space_.parts.resize(std::max(space_.parts.size(), count));
    std::span const parts = std::span(space_.parts).first(count);
    for (std::size_t i = 0; i < count; ++i) {
        Polygon& turned = parts[i];
        turned.clear();
        for (Vec2 const corner : blockers_[first + i].corners) {
            turned.push_back(offset_mm + rotate(corner, pose.axis));
        }
    }
    auto const is_within = [&](Vec2 place_mm) {
        return std::ranges::any_of(parts, [&](Polygon const& part) { return contains(part, place_mm); });
    };
    if (is_within({})) {
        return;  // the lamp stands in it
    }
    // Light sensors are on the disk around the body.
    float const clear_mm = has_sensors ? pose.radius_mm + hidden.margin_mm() : 0.0F;
    hidden.behind_outlines(parts, [&](Point centre, int) {
        Vec2 const place_mm{static_cast<float>(centre.x), static_cast<float>(centre.y)};
        return squared_length(place_mm - offset_mm) >= clear_mm * clear_mm && !is_within(place_mm);
    });
}

void LightBlockers::find_hidden_by_walls(World const& world, Vec2 source_mm, std::vector<std::uint32_t>& cells) {
    cells.clear();
    if (!world.walls_block_light || world.periodic) {
        return;
    }
    std::vector<Polygon> outlines;
    for (Polygon const& polygon : world.arena.polygons) {
        outlines.push_back(moved(polygon, -1.0F * source_mm, 0.0F));
    }
    Hidden hidden(world.light, source_mm, space_, cells);
    // Two crossings hide a place in the arena. One in a wall is lit through the other wall that a lamp outside has.
    hidden.behind_outlines(outlines, [&](Point centre, int crossings) {
        Vec2 const at_mm = source_mm + Vec2{static_cast<float>(centre.x), static_cast<float>(centre.y)};
        return crossings > 2 || world.arena.contains(at_mm);
    });
}

void LightBlockers::add_hidden_by_bodies(World const& world, Vec2 source_mm, std::vector<std::uint32_t>& cells) {
    Hidden hidden(world.light, source_mm, space_, cells);
    Vec2 const size = world.arena.bounds.size();
    int const images = world.periodic ? 1 : 0;
    for (std::size_t i = 0; i < blockers_.size(); i = end_of_body(i)) {
        Vec2 const nearest = minimum_image(world, source_mm, poses_[i].position_mm);
        float const radius = poses_[i].radius_mm;
        for (int column = -images; column <= images; ++column) {
            for (int row = -images; row <= images; ++row) {
                Vec2 const offset =
                    nearest + Vec2{static_cast<float>(column) * size.x, static_cast<float>(row) * size.y};
                bool const is_near = !world.periodic || (std::abs(offset.x) <= 0.5F * size.x + radius &&
                                                         std::abs(offset.y) <= 0.5F * size.y + radius);
                if (is_near) {
                    add_shadow(i, offset, hidden);
                }
            }
        }
    }
}

}  // namespace pogosim

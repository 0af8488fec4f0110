#include "geometry/outline_survey.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <tuple>

namespace pogosim {

namespace {

/// The order of the sweep: by x, then by y.
bool is_before(Vec2 a, Vec2 b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

/// Sign of a * d - b * c, without the rounding of the products.
int sign_of_determinant(double a, double b, double c, double d) {
    double const first = a * d;
    double const second = b * c;
    if (first != second) {
        return first > second ? 1 : -1;
    }
    double const first_rest = std::fma(a, d, -first);
    double const second_rest = std::fma(b, c, -second);
    return (first_rest > second_rest ? 1 : 0) - (first_rest < second_rest ? 1 : 0);
}

struct Edge {
    Vec2 left;   // the end that the sweep meets first
    Vec2 right;  // the end that it meets last
    EdgeOf name;
    std::size_t previous = 0;  // neighbours in the polygon, as indices into all edges
    std::size_t next = 0;
    bool runs_to_right = false;  // the polygon goes from `left` to `right`
};

/// +1 when the point is above the edge (towards larger y), -1 below, 0 on its line.
int side_of(Edge const& edge, Vec2 point) {
    double const x = edge.left.x;
    double const y = edge.left.y;
    return sign_of_determinant(edge.right.x - x, edge.right.y - y, point.x - x, point.y - y);
}

/// The point is on the line of the edge: is it also between its ends?
bool is_between_ends(Edge const& edge, Vec2 point) {
    return !is_before(point, edge.left) && !is_before(edge.right, point);
}

bool touch(Edge const& a, Edge const& b) {
    int const a_left = side_of(b, a.left);
    int const a_right = side_of(b, a.right);
    int const b_left = side_of(a, b.left);
    int const b_right = side_of(a, b.right);
    if (a_left * a_right < 0 && b_left * b_right < 0) {
        return true;
    }
    return (a_left == 0 && is_between_ends(b, a.left)) || (a_right == 0 && is_between_ends(b, a.right)) ||
           (b_left == 0 && is_between_ends(a, b.left)) || (b_right == 0 && is_between_ends(a, b.right));
}

/// Whether two neighbours leave their common corner in the same direction.
bool folds_back(Edge const& a, Edge const& b) {
    return (a.left == b.left && side_of(a, b.right) == 0) || (a.right == b.right && side_of(a, b.left) == 0);
}

class Sweep {
public:
    explicit Sweep(std::span<Polygon const> polygons) : polygons_(polygons), active_(IsBelow{this}) {
        for (std::size_t p = 0; p < polygons.size(); ++p) {
            add_edges(p);
        }
        places_.resize(edges_.size());
        survey_.parent.resize(polygons.size());
        entered_.resize(polygons.size(), false);
    }

    OutlineSurvey run() {
        for (std::size_t const corner : corners_in_order()) {
            if (!survey_.crossing) {
                pass(corner);
            }
        }
        return std::move(survey_);
    }

private:
    /// Order of the edges that the sweep line cuts. It is a total order as long as nothing crosses; what a comparison
    /// finds out about a touch is kept, and ends the sweep.
    struct IsBelow {
        Sweep* sweep;
        bool operator()(std::size_t a, std::size_t b) const { return sweep->is_below(a, b); }
    };

    void add_edges(std::size_t p) {
        Polygon const& polygon = polygons_[p];
        assert(polygon.size() >= 3);
        std::size_t const first = edges_.size();
        std::size_t const count = polygon.size();
        for (std::size_t i = 0; i < count; ++i) {
            Vec2 const from = polygon[i];
            Vec2 const to = polygon[(i + 1) % count];
            bool const forward = is_before(from, to);
            edges_.push_back({forward ? from : to, forward ? to : from, EdgeOf{p, i}, first + (i + count - 1) % count,
                              first + (i + 1) % count, forward});
        }
    }

    /// Corner k is where edge k starts.
    Vec2 corner(std::size_t k) const { return edges_[k].runs_to_right ? edges_[k].left : edges_[k].right; }

    std::vector<std::size_t> corners_in_order() {
        std::vector<std::size_t> order(edges_.size());
        for (std::size_t k = 0; k < order.size(); ++k) {
            order[k] = k;
        }
        std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return is_before(corner(a), corner(b)); });
        auto const twin =
            std::ranges::adjacent_find(order, [&](std::size_t a, std::size_t b) { return corner(a) == corner(b); });
        if (twin != order.end()) {
            report(*twin, *std::next(twin));
        }
        return order;
    }

    void pass(std::size_t corner_index) {
        std::size_t const ends[] = {edges_[corner_index].previous, corner_index};
        Vec2 const here = corner(corner_index);
        if (folds_back(edges_[ends[0]], edges_[ends[1]])) {
            report(ends[0], ends[1]);
            return;
        }
        for (std::size_t const edge : ends) {
            if (edges_[edge].right == here) {
                remove(edge);
            }
        }
        for (std::size_t const edge : ends) {
            if (edges_[edge].left == here && !survey_.crossing) {
                insert(edge);
            }
        }
        std::size_t const polygon = edges_[corner_index].name.polygon;
        if (!survey_.crossing && !entered_[polygon]) {
            entered_[polygon] = true;
            find_parent(polygon, ends[0], ends[1]);
        }
    }

    void insert(std::size_t edge) {
        auto const place = active_.insert(edge).first;
        places_[edge] = place;
        if (place != active_.begin()) {
            check(*std::prev(place), edge);
        }
        if (std::next(place) != active_.end()) {
            check(edge, *std::next(place));
        }
    }

    void remove(std::size_t edge) {
        auto const above = active_.erase(places_[edge]);
        if (above != active_.begin() && above != active_.end()) {
            check(*std::prev(above), *above);
        }
    }

    bool is_below(std::size_t a, std::size_t b) {
        if (a == b) {
            return false;
        }
        Edge const& edge_a = edges_[a];
        Edge const& edge_b = edges_[b];
        int side = 0;  // of a, seen from b
        if (edge_a.left == edge_b.left) {
            side = side_of(edge_b, edge_a.right);
        } else {
            side = is_before(edge_b.left, edge_a.left) ? side_of(edge_b, edge_a.left) : -side_of(edge_a, edge_b.left);
            if (side == 0) {
                check(a, b);
            }
        }
        return side != 0 ? side < 0 : a < b;
    }

    void check(std::size_t a, std::size_t b) {
        bool const neighbours = edges_[a].previous == b || edges_[a].next == b;
        if (!neighbours && touch(edges_[a], edges_[b])) {
            report(a, b);
        }
    }

    void report(std::size_t a, std::size_t b) {
        if (!survey_.crossing) {
            survey_.crossing = {edges_[std::min(a, b)].name, edges_[std::max(a, b)].name};
        }
    }

    /// At its leftmost corner a polygon is inside what the edge below borders: that edge's polygon or the one around
    /// it.
    void find_parent(std::size_t polygon, std::size_t a, std::size_t b) {
        auto const lowest = is_below(a, b) ? places_[a] : places_[b];
        if (lowest == active_.begin()) {
            return;
        }
        Edge const& below = edges_[*std::prev(lowest)];
        std::size_t const owner = below.name.polygon;
        bool const inside_above = below.runs_to_right == (signed_area(polygons_[owner]) > 0.0);
        survey_.parent[polygon] = inside_above ? std::optional(owner) : survey_.parent[owner];
    }

    std::span<Polygon const> polygons_;
    std::vector<Edge> edges_;
    std::set<std::size_t, IsBelow> active_;  // from bottom to top
    std::vector<std::set<std::size_t, IsBelow>::iterator> places_;
    std::vector<bool> entered_;
    OutlineSurvey survey_;
};

}  // namespace

OutlineSurvey survey_outlines(std::span<Polygon const> polygons) {
    return Sweep(polygons).run();
}

}  // namespace pogosim

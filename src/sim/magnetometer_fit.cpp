#include "sim/magnetometer_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/exact_math.hpp"
#include "base/log.hpp"

namespace pogosim {

namespace {

/// 1, cos a, sin a, cos 2a, sin 2a, ...
std::vector<double> basis_at(double angle_rad, int order) {
    std::vector<double> basis{1.0};
    for (int k = 1; k <= order; ++k) {
        auto const [sine, cosine] = exact::sine_cosine(k * angle_rad);
        basis.push_back(cosine);
        basis.push_back(sine);
    }
    return basis;
}

/// The normal equations: a symmetric matrix, of which the lower half is stored, and a right-hand side for each axis.
struct NormalEquations {
    std::vector<std::vector<double>> matrix;
    std::vector<Axes> right;
};

NormalEquations normal_equations(std::span<MagneticRow const> rows, int order, double ridge) {
    std::size_t const count = coefficient_count(order);
    NormalEquations equations{.matrix = std::vector(count, std::vector<double>(count)),
                              .right = std::vector<Axes>(count)};
    for (MagneticRow const& row : rows) {
        std::vector<double> const basis = basis_at(row.angle_rad, order);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                equations.matrix[i][j] += basis[i] * basis[j];
            }
            for (std::size_t axis = 0; axis < row.reading.size(); ++axis) {
                equations.right[i][axis] += basis[i] * row.reading[axis];
            }
        }
    }
    for (std::size_t i = 1; i < count; ++i) {
        equations.matrix[i][i] += ridge;
    }
    return equations;
}

/// Replaces the matrix by its Cholesky factor. False if it is singular or ill-conditioned: the fit would amplify noise
/// about a thousand times.
bool factorise(std::vector<std::vector<double>>& matrix) {
    constexpr double kLeastPivot = 1e-6;  // relative to the largest element
    double largest = 0.0;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        largest = std::max(largest, matrix[i][i]);
    }
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double rest = matrix[i][j];
            for (std::size_t k = 0; k < j; ++k) {
                rest -= matrix[i][k] * matrix[j][k];
            }
            if (i == j && !(rest > kLeastPivot * largest)) {
                return false;
            }
            matrix[i][j] = i == j ? std::sqrt(rest) : rest / matrix[j][j];
        }
    }
    return true;
}

/// Solves by the factor L of the matrix: L y = right, then L^T x = y.
void solve(std::vector<std::vector<double>> const& factor, std::vector<Axes>& right) {
    std::size_t const count = right.size();
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                right[i][axis] -= factor[i][k] * right[k][axis];
            }
            right[i][axis] /= factor[i][i];
        }
        for (std::size_t i = count; i-- > 0;) {
            for (std::size_t k = i + 1; k < count; ++k) {
                right[i][axis] -= factor[k][i] * right[k][axis];
            }
            right[i][axis] /= factor[i][i];
        }
    }
}

MagneticCurve curve_of(std::vector<Axes> const& coefficients, int order) {
    MagneticCurve curve{.constant = coefficients[0], .order = order};
    for (std::size_t k = 0; k < static_cast<std::size_t>(order); ++k) {
        curve.cosine[k] = coefficients[2 * k + 1];
        curve.sine[k] = coefficients[2 * k + 2];
    }
    return curve;
}

Axes rms_error(std::span<MagneticRow const> rows, std::vector<Axes> const& coefficients, int order) {
    Axes squares{};
    for (MagneticRow const& row : rows) {
        std::vector<double> const basis = basis_at(row.angle_rad, order);
        for (std::size_t axis = 0; axis < squares.size(); ++axis) {
            double residual = row.reading[axis];
            for (std::size_t i = 0; i < basis.size(); ++i) {
                residual -= basis[i] * coefficients[i][axis];
            }
            squares[axis] += residual * residual;
        }
    }
    for (double& square : squares) {
        square = std::sqrt(square / static_cast<double>(rows.size()));
    }
    return squares;
}

}  // namespace

std::optional<MagneticFit> fit_magnetic_curve(std::span<MagneticRow const> rows, int order, double ridge) {
    if (rows.size() < coefficient_count(order)) {
        return std::nullopt;
    }
    NormalEquations equations = normal_equations(rows, order, ridge);
    if (!factorise(equations.matrix)) {
        return std::nullopt;
    }
    solve(equations.matrix, equations.right);
    return MagneticFit{.curve = curve_of(equations.right, order), .rms_error = rms_error(rows, equations.right, order)};
}

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDegree = std::numbers::pi / 180.0;

using Distances = std::vector<Axes>;  // from a curve, for each row

double median(std::vector<double> values) {
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

Axes reading_at(MagneticCurve const& curve, double angle_rad) {
    Axes reading = curve.constant;
    for (int k = 1; k <= curve.order; ++k) {
        auto const [sine, cosine] = exact::sine_cosine(k * angle_rad);
        auto const index = static_cast<std::size_t>(k - 1);
        for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
            reading[axis] += cosine * curve.cosine[index][axis] + sine * curve.sine[index][axis];
        }
    }
    return reading;
}

/// Rows in the middle half of the readings of each axis, and around it.
std::vector<bool> near_the_quartiles(std::span<MagneticRow const> rows) {
    constexpr double kFar = 3.0;        // times the distance of the quartiles
    constexpr double kLeastWidth = 10;  // counts
    std::vector<bool> is_near(rows.size(), true);
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
        std::vector<double> sorted;
        for (MagneticRow const& row : rows) {
            sorted.push_back(row.reading[axis]);
        }
        std::ranges::sort(sorted);
        double const low = sorted[sorted.size() / 4];
        double const high = sorted[3 * sorted.size() / 4];
        double const far = kFar * std::max(high - low, kLeastWidth);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            is_near[i] = is_near[i] && rows[i].reading[axis] >= low - far && rows[i].reading[axis] <= high + far;
        }
    }
    return is_near;
}

/// The distance of each row from the curve of the rows that are near, in units of the usual distance of these.
std::optional<std::vector<double>> relative_distances(std::span<MagneticRow const> rows,
                                                      std::vector<bool> const& is_near, int order, double ridge) {
    constexpr double kOfNormal = 1.4826;  // standard deviation of a normal distribution over the median of its size
    constexpr double kLeastScale = 1.0;   // counts: readings are whole
    std::vector<MagneticRow> near;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (is_near[i]) {
            near.push_back(rows[i]);
        }
    }
    auto const fit = fit_magnetic_curve(near, order, ridge);
    if (!fit) {
        return std::nullopt;
    }
    std::vector<double> relative(rows.size(), 0.0);
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
        std::vector<double> distances;
        std::vector<double> of_near;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            distances.push_back(std::abs(rows[i].reading[axis] - reading_at(fit->curve, rows[i].angle_rad)[axis]));
            if (is_near[i]) {
                of_near.push_back(distances.back());
            }
        }
        double const scale = std::max(kOfNormal * median(of_near), kLeastScale);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            relative[i] = std::max(relative[i], distances[i] / scale);
        }
    }
    return relative;
}

/// What there is of an ellipse: semi-axes of x and y, counts, and what those of readings without one may be by chance.
struct EllipseSize {
    double major;
    double minor;
    double chance;
};

EllipseSize ellipse_size(MagneticFit const& fit, std::size_t rows) {
    constexpr double kSignificant = 4.0;  // times the error of all four coefficients
    Axes const& cosine = fit.curve.cosine[0];
    Axes const& sine = fit.curve.sine[0];
    double const sum = std::hypot(cosine[0] + sine[1], cosine[1] - sine[0]);
    double const difference = std::hypot(cosine[0] - sine[1], cosine[1] + sine[0]);
    double const noise = std::hypot(fit.rms_error[0], fit.rms_error[1]);
    double const least = 1e-9 * (1.0 + std::max(std::abs(fit.curve.constant[0]), std::abs(fit.curve.constant[1])));
    return {.major = (sum + difference) / 2.0,
            .minor = std::abs(sum - difference) / 2.0,
            .chance = std::max(least, kSignificant * noise * std::sqrt(4.0 / static_cast<double>(rows)))};
}

bool runs_backwards(MagneticFit const& fit) {
    constexpr double kSignificant = 4.0;  // times the residuals
    Axes const& cosine = fit.curve.cosine[0];
    Axes const& sine = fit.curve.sine[0];
    double const noise = std::max(fit.rms_error[0], fit.rms_error[1]);
    double const area = cosine[0] * sine[1] - cosine[1] * sine[0];
    return area < -kSignificant * noise * kSignificant * noise;
}

}  // namespace

double largest_gap_rad(std::span<MagneticRow const> rows) {
    std::vector<double> angles;
    for (MagneticRow const& row : rows) {
        angles.push_back(row.angle_rad - kTurn * std::floor(row.angle_rad / kTurn));
    }
    std::ranges::sort(angles);
    double gap = angles.empty() ? kTurn : angles.front() + kTurn - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) {
        gap = std::max(gap, angles[i] - angles[i - 1]);
    }
    return gap;
}

std::string note_on_unit(std::span<MagneticRow const> rows, MagnetometerTable const& table, double field_angle_rad) {
    constexpr double kMost = 1.02 * kTurn;  // of angles around a turn in radians
    auto const are_within = [&](double largest_rad) {
        return std::ranges::all_of(
            rows, [&](auto const& row) { return std::abs(field_angle_rad - row.angle_rad) <= largest_rad; });
    };
    if (table.angle_unit == AngleUnit::degrees && rows.size() > 1 && are_within(kMost * kDegree)) {
        return " If the table has radians, set magnetometer.csv.input_angle_unit to radians.";
    }
    return table.angle_unit == AngleUnit::radians && !are_within(kMost)
               ? " If the table has degrees, set magnetometer.csv.input_angle_unit to degrees."
               : "";
}

std::vector<MagneticRow> outliers_of(std::span<MagneticRow const> rows, int order, double ridge) {
    constexpr double kNear = 6.0;
    constexpr double kOutlier = 10.0;
    constexpr int kMostRounds = 10;
    constexpr std::size_t kMostShare = 4;
    if (rows.empty()) {
        return {};
    }
    // Rows that were near the curve of others give a better one.
    std::vector<bool> is_near = near_the_quartiles(rows);
    std::optional<std::vector<double>> relative;
    for (int round = 0; round < kMostRounds; ++round) {
        relative = relative_distances(rows, is_near, order, ridge);
        if (!relative) {
            return {};
        }
        std::vector<bool> next;
        for (double const distance : *relative) {
            next.push_back(distance <= kNear);
        }
        if (next == is_near) {
            break;
        }
        is_near = std::move(next);
    }
    std::vector<MagneticRow> outliers;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if ((*relative)[i] > kOutlier) {
            outliers.push_back(rows[i]);
        }
    }
    return kMostShare * outliers.size() > rows.size() ? std::vector<MagneticRow>() : outliers;
}

void warn_of_doubts(std::string const& place, std::string const& file, std::span<MagneticRow const> rows,
                    MagnetometerTable const& table, double field_angle_rad) {
    constexpr double kLargestGap = 90.0 * kDegree + 1e-6;
    if (double const gap = largest_gap_rad(rows); gap > kLargestGap) {
        log().warn(
            "{}: '{}' has no readings in {:.0f} of 360 degrees, where the curve is a guess, and it may be wrong "
            "elsewhere; take readings all around the turn.{}",
            place, file, gap / kDegree, note_on_unit(rows, table, field_angle_rad));
    }
    std::vector<MagneticRow> const outliers = outliers_of(rows, table.harmonic_order, table.ridge);
    if (!outliers.empty()) {
        auto const& [x, y, z] = outliers.front().reading;
        log().warn(
            "{}:{}: {:g}, {:g}, {:g} is far from the curve of the other rows{}; it distorts the fit{}: correct "
            "or delete it",
            file, outliers.front().line, x, y, z,
            outliers.size() == 1 ? "" : fmt::format(", like {} more", outliers.size() - 1),
            table.residual_is_noise ? ", and makes the noise of all robots larger" : "");
    }
    auto const fit = fit_magnetic_curve(rows, table.harmonic_order, table.ridge);
    if (!fit) {
        return;
    }
    EllipseSize const size = ellipse_size(*fit, rows.size());
    if (size.minor <= size.chance && outliers.empty()) {  // which may hide an ellipse
        log().warn(
            "{}: x and y of '{}' {}, so robots cannot tell headings by them; check that the headings and the columns "
            "belong to the readings.{}",
            place, file,
            size.major <= size.chance ? "hardly depend on the heading" : "move along a line, not around an ellipse",
            note_on_unit(rows, table, field_angle_rad));
    } else if (runs_backwards(*fit)) {
        log().warn(
            "{}: as the headings of '{}' grow, x and y run around their ellipse the other way than with source: "
            "procedural; that is right if the headings count clockwise seen from above, else change their signs",
            place, file);
    }
}

}  // namespace pogosim

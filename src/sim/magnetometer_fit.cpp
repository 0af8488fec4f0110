#include "sim/magnetometer_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/exact_math.hpp"

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

}  // namespace pogosim

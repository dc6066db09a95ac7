#pragma once
// Affine maps in long double, for evaluations that tests compare the program with.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchstone::test {

using Real = long double;
using Real3 = std::array<Real, 3>;
/// Rows of an affine map: linear part and translation.
using Affine = std::array<std::array<Real, 4>, 3>;

inline constexpr Affine kIdentity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

inline Affine operator*(const Affine& a, const Affine& b) {
    Affine result{};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 4; ++c) {
            for (size_t k = 0; k < 3; ++k)
                result[r][c] += a[r][k] * b[k][c];
            result[r][c] += c == 3 ? a[r][3] : 0;
        }
    return result;
}

inline Real3 point(const Affine& m, const Real3& p) {
    Real3 result{};
    for (size_t r = 0; r < 3; ++r)
        result[r] = m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3];
    return result;
}

/// The matrix of cofactors: the inverse transpose times the determinant.
inline std::array<Real3, 3> cofactors(const Affine& m) {
    std::array<Real3, 3> result{};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c) {
            const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            result[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    return result;
}

inline Real determinant(const Affine& m) {
    const auto cofactor = cofactors(m);
    return m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
}

inline Affine inverse(const Affine& m) {
    const auto cofactor = cofactors(m);
    const Real whole = determinant(m);
    Affine result{};
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c)
            result[r][c] = cofactor[c][r] / whole;
        result[r][3] = -(result[r][0] * m[0][3] + result[r][1] * m[1][3] + result[r][2] * m[2][3]);
    }
    return result;
}

inline Real3 unit(const Real3& v) {
    const Real length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

inline Real lengthOf(const Real3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// How much shorter the cofactors make `n` than they make some direction: 1 where they turn and scale evenly.
inline Real steadiness(const Affine& m, const Real3& n) {
    const auto cofactor = cofactors(m);
    Real3 image{};
    Real all = 0;
    for (size_t r = 0; r < 3; ++r) {
        image[r] = cofactor[r][0] * n[0] + cofactor[r][1] * n[1] + cofactor[r][2] * n[2];
        all += lengthOf(cofactor[r]);
    }
    return all > 0 ? lengthOf(image) / all : 0;
}

/// A unit normal under the inverse transpose of `m`.
inline Real3 normalUnder(const Affine& m, const Real3& n) {
    const auto cofactor = cofactors(m);
    const Real turn = determinant(m) < 0 ? -1 : 1;
    Real3 result{};
    for (size_t r = 0; r < 3; ++r)
        result[r] = turn * (cofactor[r][0] * n[0] + cofactor[r][1] * n[1] + cofactor[r][2] * n[2]);
    return unit(result);
}

inline Affine fromColumns(const std::vector<Real>& m) {
    Affine result{};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 4; ++c)
            result[r][c] = m[4 * c + r];
    return result;
}

inline Affine fromTrs(const Real3& t, std::array<Real, 4> q, const Real3& s) {
    const Real length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (Real& each : q)
        each /= length;
    const auto [x, y, z, w] = q;
    const Real rotation[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                 {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                 {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    Affine result{};
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c)
            result[r][c] = rotation[r][c] * s[c];
        result[r][3] = t[r];
    }
    return result;
}

} // namespace touchstone::test

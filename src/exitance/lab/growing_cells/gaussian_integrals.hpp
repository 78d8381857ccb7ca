#pragma once

#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

// Integrals of Gaussians exp(-|x - c|^2 / d^2) and of their products over planes and polygons, in closed form. A
// product of two is one Gaussian again, which the transfer coefficients of growing cells rest on.

/// amplitude exp(-|x - centre|^2 / width^2)
struct Gaussian {
    Point centre;
    double width = 1;  ///< metres
    double amplitude = 1;
};

/// Of widths d and e about points f apart, exp(-f^2 / (d^2 + e^2)) times a Gaussian of width d e / sqrt(d^2 + e^2).
Gaussian product(const Gaussian& a, const Gaussian& b);

/// Over all of a plane through `at` of normal n: pi d^2 exp(-h^2 / d^2), h the distance of the centre from it. m^2.
double integral_over_plane(const Gaussian& g, const Point& at, const Normal& n);

/// Over the parallelogram or triangle `corners` (3 or 4, in order). Rectangles are exact, by error functions, since a
/// Gaussian is a product in every frame of right angles. Other shapes are cut into triangles, these into right-angled
/// ones at the foot of the centre; what is left there is an integral over one angle,
///
///     int (1 - exp(-a^2 / (d^2 cos^2 t))) dt,    a the distance of the foot from the edge,
///
/// by Gauss-Legendre: relative to pi d^2 right to 1e-9 or so. m^2.
double integral_over_polygon(const Gaussian& g, std::span<const Point> corners, const Normal& n);

/// k_pqo = int int Phi_p(x) Phi_q(y) Omega_o(x, y) dx dy over the planes of p and q: the transfer between two units of
/// the shading network by one of the kernel network, Omega_o = exp(-(|x - o_x|^2 + |y - o_y|^2) / d_o^2). The published
/// chain of equations loses a factor of two in an exponent on the way (docs/growing_cells.md).
struct SurfaceGaussian {
    Point at;
    Normal n;
    double width = 1;
};
double transfer(const SurfaceGaussian& p, const SurfaceGaussian& q, const Point& o_x, const Point& o_y, double o_width);

}  // namespace exitance

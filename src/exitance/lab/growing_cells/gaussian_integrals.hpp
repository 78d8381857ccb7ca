#pragma once

#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

// Closed-form integrals of Gaussians exp(-|x - c|^2 / d^2), and of their products, over planes and polygons. The
// product of two Gaussians is a Gaussian; the transfer coefficients of growing cells are based on this.

/// amplitude exp(-|x - centre|^2 / width^2)
struct Gaussian {
    Point centre;
    double width = 1;  ///< metres
    double amplitude = 1;
};

/// Product of two Gaussians: for widths d and e with centres f apart, exp(-f^2 / (d^2 + e^2)) times a Gaussian of width
/// d e / sqrt(d^2 + e^2).
Gaussian product(const Gaussian& a, const Gaussian& b);

/// Integral over a whole plane through `at` with normal n: pi d^2 exp(-h^2 / d^2), where h is the distance of the
/// centre from the plane. m^2.
double integral_over_plane(const Gaussian& g, const Point& at, const Normal& n);

/// Integral over the parallelogram or triangle `corners` (3 or 4, in order), m^2. Rectangles are exact, by error
/// functions, since a Gaussian is separable in every orthogonal frame. Other shapes are divided into triangles, and
/// these into right triangles at the foot of the centre, where a one-dimensional integral over an angle remains:
///
///     int (1 - exp(-a^2 / (d^2 cos^2 t))) dt,    a = distance of the foot from the edge,
///
/// computed by Gauss-Legendre quadrature. Error: about 1e-9 of pi d^2.
double integral_over_polygon(const Gaussian& g, std::span<const Point> corners, const Normal& n);

/// Transfer coefficient between two units p, q of the shading network and one unit o of the kernel network: k_pqo = int
/// int Phi_p(x) Phi_q(y) Omega_o(x, y) dx dy over the planes of p and q, with Omega_o = exp(-(|x - o_x|^2 + |y -
/// o_y|^2) / d_o^2). The published derivation loses a factor of two in an exponent (docs/methods/growing_cells.md).
struct SurfaceGaussian {
    Point at;
    Normal n;
    double width = 1;
};
double transfer(const SurfaceGaussian& p, const SurfaceGaussian& q, const Point& o_x, const Point& o_y, double o_width);

}  // namespace exitance

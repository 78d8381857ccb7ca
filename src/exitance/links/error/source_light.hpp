#pragma once

#include <array>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// One value per node of an element (at most nine nodes), or, for a point, the transport from each node of a source.
using NodeRow = std::array<double, 9>;

/// An element as a source: w b at its nodes, where w is the receiver's reflectance; mean over bands, W/m^2.
struct SourceLight {
    ElementId element;
    Normal normal;
    std::size_t nodes = 0;
    std::array<Point, 9> node;
    NodeRow weight{}, light{};  ///< Weights of the basis's rule; w b at the nodes.
    double mean = 0;            ///< Mean of the light.
    double roughness = 0;       ///< RMS difference between the light and the element's polynomial.
    double area_over_pi = 0;    ///< m^2

    /// Light received through a row, W/m^2.
    double received(const NodeRow& row) const {
        double sum = 0;
        for (std::size_t l = 0; l < nodes; ++l) sum += row[l] * light[l];
        return sum;
    }
    /// Unoccluded transport to x from each node (irradiance for b = 1 there), by the basis's rule: w_l A cos cos / (pi
    /// r^2).
    NodeRow kernel_row(const Point& x, const Normal& n) const;
    /// Like kernel_row(), from a single point y of the source for its whole area.
    double kernel_from(const Point& y, const Point& x, const Normal& n) const;
};

/// Makes the source's data. `roughness`: of b on the element; `w`: the receiver's reflectance.
SourceLight source_light(const LinkSites& sites, const NodalField& b, double roughness, ElementId element,
                         const Spectrum& w);

}  // namespace exitance

#pragma once

#include <array>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// A number a node of an element, of which there are at most nine; or of a point: what each node of a source sends it.
using NodeRow = std::array<double, 9>;

/// An element as it sends light: w b at its nodes, with w the receiver's reflectance, in mean bands, W/m^2.
struct SourceLight {
    ElementId element;
    Normal normal;
    std::size_t nodes = 0;
    std::array<Point, 9> node;
    NodeRow weight{}, light{};  ///< Of the basis's rule; w b.
    double mean = 0;            ///< Of the light.
    double roughness = 0;       ///< RMS of the light's departure from the element's polynomial.
    double area_over_pi = 0;    ///< m^2

    /// Light that a row brings, W/m^2.
    double received(const NodeRow& row) const {
        double sum = 0;
        for (std::size_t l = 0; l < nodes; ++l) sum += row[l] * light[l];
        return sum;
    }
    /// What each node sends to x in the open, for b = 1 there, by the basis's rule: w_l A cos cos / (pi r^2).
    NodeRow kernel_row(const Point& x, const Normal& n) const;
    /// The same of one point of the source, for all of its area.
    double kernel_from(const Point& y, const Point& x, const Normal& n) const;
};

/// `roughness` of b on the element, `w` as above.
SourceLight source_light(const LinkSites& sites, const NodalField& b, double roughness, ElementId element,
                         const Spectrum& w);

}  // namespace exitance

#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A triangle on a surface with irradiance as one quadratic polynomial.
struct QuadraticTriangle {
    RegionId region;
    std::array<Point, 3> corners;    ///< metres
    std::array<Spectrum, 6> values;  ///< At corners 0, 1, 2 and the middles of edges 01, 12, 20, W/m^2.
};

/// Irradiance in a representation of the method's own, in addition to the elements of a Solution: the cells of a
/// network, or one mesh per source. The engine evaluates it, bakes it and keeps it in checkpoints; only the method can
/// interpret its content.
class LightForm {
  public:
    virtual ~LightForm() = default;

    /// Returns the name under which `add_light_form` registered this representation.
    virtual std::string_view kind() const = 0;
    /// Irradiance at a point of a region, W/m^2.
    virtual Spectrum at(const Scene& scene, RegionId region, const Point& x) const = 0;

    /// Number of triangles; 0 if the representation is not piecewise quadratic.
    virtual std::size_t triangle_count() const { return 0; }
    /// Triangle `i` with its values multiplied by `weight`.
    virtual QuadraticTriangle triangle(const Scene& scene, std::size_t i, const Spectrum& weight) const;

    /// Returns this light after its lamps were dimmed: each light group is multiplied by its factor, which counts from
    /// the undimmed light. Null if the representation does not separate these groups.
    using GroupFactors = std::span<const std::pair<std::string, double>>;
    virtual std::shared_ptr<const LightForm> dimmed(GroupFactors) const { return {}; }

    /// Returns the whole representation as bytes, which the `unpack` of its kind reads on a machine of the same type.
    virtual std::string packed() const = 0;
};

/// Solutions are copied; forms are large and never change once they are made.
using LightFormPointer = std::shared_ptr<const LightForm>;

/// A representation that checkpoints can store.
struct LightFormKind {
    std::string_view name;
    LightFormPointer (*unpack)(std::string_view bytes);
};

/// Registers a kind of light form. Must not be called while other threads solve or load.
void add_light_form(const LightFormKind& kind);

/// The form of the kind `name` in `bytes`; null for an empty name. Aborts if no kind has this name.
LightFormPointer unpack_light_form(std::string_view name, std::string_view bytes);

}  // namespace exitance

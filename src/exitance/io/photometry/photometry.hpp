#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// The luminous opening of a luminaire, about the luminaire's origin.
struct Opening {
    enum class Shape : std::uint8_t {
        point,
        rectangle,
        ellipse,  ///< Or a circle.
        box,
        cylinder_x,  ///< A cylinder whose axis is the luminaire's x,
        cylinder_y,  ///< y
        cylinder_z,  ///< or z axis; its two other sizes are its diameters.
        ellipsoid,   ///< Or a sphere.
    };
    Shape shape = Shape::point;
    Vec3 size;  ///< Along the luminaire's x, y and z axes, metres.
    /// Heights of the dark upper parts of a box's sides towards +-x and towards +-y, metres: at most size.z.
    double dark_x = 0, dark_y = 0;
};

/// What an opening's shape is called.
const char* name_of(Opening::Shape shape);

/// A photometric file: intensity by direction, and what it says of the luminaire.
///
/// The luminaire's frame: type C (and EULUMDAT) has its C0 plane along +x, C90 along +y and gamma = 0 down, along -z.
/// Types A and B have their beam (H, V) = (0, 0) along -z as well, positive V towards +x and positive H towards +y.
/// The table is kept as one over two angles whatever the type: theta from -axis_z of the table's own frame, phi about
/// it from axis_x towards axis_y, all symmetries written out. So types A and B, which turn about another axis than C,
/// are of the same form; where the file says nothing the table is 0.
struct Photometry {
    enum class Type : std::uint8_t { c, b, a };

    std::string file;
    std::string format;  ///< "IESNA:LM-63-2002", "EULUMDAT", ...
    Type type = Type::c;
    std::string symmetry;                                       ///< In words.
    std::vector<std::pair<std::string, std::string>> keywords;  ///< As the file has them, in its order.
    int lamps = 1;
    std::optional<double> lamp_lumens;          ///< Of all lamps together, lm; none: absolute photometry.
    double watts = 0;                           ///< 0: not said.
    std::optional<double> stated_output_ratio;  ///< LORL of EULUMDAT, a share.
    Opening opening;
    std::optional<Vec3> housing;  ///< Length, width and height of the luminaire where the file says so, metres.

    Vec3 axis_x{1, 0, 0}, axis_y{0, 1, 0}, axis_z{0, 0, 1};  ///< The table's frame within the luminaire's.
    std::vector<double> theta;                               ///< Degrees, ascending within [0, 180].
    std::vector<double> phi;        ///< Degrees: {0} (all planes alike), or ascending from 0 to 360.
    std::vector<double> candela;    ///< cd, phi by phi, the thetas of one side by side.
    std::vector<Finding> findings;  ///< What was repaired, or is to be known.

    double at(std::size_t p, std::size_t t) const { return candela[p * theta.size() + t]; }
    /// Intensity (cd) in a direction of the luminaire's frame, of length 1: bilinear in the angles.
    double intensity(const Vec3& d) const;
    double largest() const;  ///< cd, of the table.
    /// Flux (lm) between two angles theta of the table, degrees: the exact integral of the bilinear interpolant.
    double flux(double from = 0, double to = 180) const;
    double efficacy() const { return watts > 0 ? flux() / watts : 0; }  ///< lm/W; 0 where watts are not said.
};

/// Angles (degrees) over which light is at least a share of the largest intensity, in one plane through the axis:
/// from the axis to either side, at most 90. `towards` of length 1 spans the plane with the axis.
struct BeamSpread {
    double left = 0, right = 0;  ///< Towards -towards and +towards.
    double whole() const { return left + right; }
};
/// share: 0.5 for the beam angle, 0.1 for the field angle (of the largest intensity of that plane below the horizontal;
/// where nothing goes down, of that above it, about the zenith). Where the largest does not lie on the axis the angle
/// goes on to the last direction that holds the share.
BeamSpread beam_spread(const Photometry& p, const Vec3& towards, double share);

/// Degrees between an entry and the 0 beside it, where a table ends at a value.
inline constexpr double table_jump = 1e-6;

/// Adds a finding of kind `repair` or `warning`.
void tell(Photometry& p, Finding::Kind kind, int line, std::string message, std::string hint = "");

}  // namespace exitance

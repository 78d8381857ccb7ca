#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Luminous opening of a luminaire, centred at the luminaire's origin.
struct Opening {
    enum class Shape : std::uint8_t {
        point,
        rectangle,
        ellipse,  ///< Ellipse or circle.
        box,
        cylinder_x,  ///< Cylinder along the luminaire's x axis; the other two sizes are its diameters.
        cylinder_y,  ///< Cylinder along y.
        cylinder_z,  ///< Cylinder along z.
        ellipsoid,   ///< Ellipsoid or sphere.
    };
    Shape shape = Shape::point;
    Vec3 size;  ///< Along the luminaire's x, y and z axes, metres.
    /// Heights of the dark upper parts of a box's sides that face +-x and +-y, metres; at most size.z.
    double dark_x = 0, dark_y = 0;
};

/// Name of a shape.
const char* name_of(Opening::Shape shape);

/// Content of a photometric file: intensity by direction, and data about the luminaire.
///
/// The luminaire's frame: in type C (and EULUMDAT), the C0 plane is along +x, C90 along +y, and gamma = 0 is down,
/// along -z. In types A and B, the beam (H, V) = (0, 0) is along -z, positive V towards +x and positive H towards +y.
/// The table has the same form for all types: theta is measured from -axis_z of the table's own frame, phi about it
/// from axis_x towards axis_y, with all symmetries expanded. Types A and B only differ from C by their axis. Outside
/// the file's angles the table is 0.
struct Photometry {
    enum class Type : std::uint8_t { c, b, a };

    std::string file;
    std::string format;  ///< "IESNA:LM-63-2002", "EULUMDAT", ...
    Type type = Type::c;
    std::string symmetry;  ///< Symmetry in words, for reports.
    /// Keywords and their values, in the order of the file.
    std::vector<std::pair<std::string, std::string>> keywords;
    int lamps = 1;
    std::optional<double> lamp_lumens;          ///< Total flux of the lamps, lm; empty: absolute photometry.
    double watts = 0;                           ///< 0: unknown.
    std::optional<double> stated_output_ratio;  ///< EULUMDAT's LORL, in [0, 1].
    Opening opening;
    std::optional<Vec3> housing;  ///< Length, width and height of the luminaire, metres; empty: unknown.

    Vec3 axis_x{1, 0, 0}, axis_y{0, 1, 0}, axis_z{0, 0, 1};  ///< Axes of the table in the luminaire's frame.
    std::vector<double> theta;                               ///< Vertical angles, degrees, ascending within [0, 180].
    std::vector<double> phi;        ///< Degrees: {0} (rotational symmetry), or ascending from 0 to 360.
    std::vector<double> candela;    ///< Intensities, cd; theta varies fastest.
    std::vector<Finding> findings;  ///< Repairs and warnings.

    double at(std::size_t p, std::size_t t) const { return candela[p * theta.size() + t]; }
    /// Intensity (cd) in a direction of length 1 in the luminaire's frame, interpolated bilinearly in the angles.
    double intensity(const Vec3& d) const;
    double largest() const;  ///< Largest intensity of the table, cd.
    /// Flux (lm) between two angles theta of the table, degrees. Exact for the bilinear interpolant.
    double flux(double from = 0, double to = 180) const;
    double efficacy() const { return watts > 0 ? flux() / watts : 0; }  ///< lm/W; 0 if the power is unknown.
};

/// Angular range in a plane through the axis in which the intensity is at least a share of the maximum: degrees from
/// the axis to each side, at most 90. The plane is spanned by the axis and the unit vector `towards`.
struct BeamSpread {
    double left = 0, right = 0;  ///< Degrees from the axis, away from `towards` and to it.
    double whole() const { return left + right; }
};
/// Computes the spread for a `share` of the largest intensity in that plane below the horizontal: 0.5 for the beam
/// angle, 0.1 for the field angle. If there is no light downwards, the maximum above the horizontal is used, with
/// angles from the zenith. If the maximum is off the axis, the range extends to the last direction with that share.
BeamSpread beam_spread(const Photometry& p, const Vec3& towards, double share);

/// Degrees from the last entry of a table, if its intensity is not 0, to the 0 that is added behind it.
inline constexpr double table_jump = 1e-6;

/// Adds a finding of kind `repair` or `warning`.
void tell(Photometry& p, Finding::Kind kind, int line, std::string message, std::string hint = "");

}  // namespace exitance

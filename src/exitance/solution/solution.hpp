#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exitance/links/kept_link.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solution/light_form.hpp"

namespace exitance {

/// Irradiance as one polynomial a leaf: linear on triangles, bilinear on parallelograms, given by its values at the
/// leaf's corners (Patch::corner). Values of neighbours need not agree: edges may be sharp. W/m^2.
struct ElementFunction {
    ElementTree tree;
    Field<ElementId, std::uint32_t> first_value;  ///< A leaf's first corner in `values`; of inner elements: unused.
    std::vector<std::array<float, bands>> values;

    void add_value(const Spectrum& value);
    /// The value at (u, v) of a leaf; 0 for none, as a locator finds it for a point that is not finite.
    Spectrum at(ElementTree::Place place) const;
};

/// Emitted flux, what became of it, and how far the two are apart: all bands as one number, by `own_unit` of the scene.
struct EnergyBalance {
    double emitted = 0;   ///< int M dA
    double absorbed = 0;  ///< int (1 - rho) E dA
    double escaped = 0;   ///< int B dA, of what meets no front, by few rays; 0 in closed scenes.
    double defect = 0;    ///< |emitted - absorbed - escaped| / emitted
};

/// Light of a room (LightRooms) and its error.
struct RoomError {
    double area = 0;   ///< m^2
    double mean = 0;   ///< Mean reflected radiosity over the room's surfaces and the bands, W/m^2; 0 in the dark.
    double error = 0;  ///< RMS error of radiosity relative to `reference`.
    /// The light that the error is relative to, W/m^2: `mean`, or a small share of the brightest room's where that is
    /// larger, since no error can be relative to darkness.
    double reference = 0;
};

/// Light of a body (`find_bodies`), and how far it is off.
struct BodyError {
    std::size_t surfaces = 0;  ///< Number of its faces.
    double area = 0;           ///< m^2
    double mean = 0;           ///< Reflected radiosity, mean over its surfaces and the bands, W/m^2.
    /// RMS error of radiosity relative to `mean` or a tenth of its room's mean, whichever is larger; none where fewer
    /// than eight points lie on it.
    std::optional<double> error;
    std::size_t points = 0;  ///< At which it was measured.
    SurfaceId first;         ///< The first of its faces.
};

/// How far the light of one input face is off.
struct FaceError {
    double error = 0;        ///< RMS error of radiosity, relative to the mean reflected radiosity of its room.
    std::size_t points = 0;  ///< It was measured at; 0 where they were too few: the error is then that of its room.
};

/// What discontinuity meshing made.
struct DiscontinuityCounts {
    std::size_t d0 = 0, d1 = 0, d2 = 0, eee = 0, left_out = 0;  ///< Curves; sources and curves that change too little.
    std::size_t wedges = 0;
    std::size_t lit = 0, penumbra = 0, umbra = 0;  ///< Faces between the curves, before they are bisected.
    std::size_t triangles = 0;
    double mean_radius_ratio = 0;
};

/// What a solve took and what it reached: the keys of `solve --json` and `stats --json`, in their order.
struct SolveStatistics {
    std::string method, basis, schedule;
    int threads = 1;
    std::size_t surfaces = 0, elements = 0, leaf_elements = 0, links = 0;
    std::size_t rays = 0, form_factors = 0, iterations = 0;
    bool converged = false;  ///< The error asked for was reached, or none was asked for.
    double residual = 0;     ///< Of the discrete system, relative to its right-hand side.
    /// Of what `probe` evaluates, and the same as an upper bound; none where a run was stopped before its first
    /// estimate.
    std::optional<double> relative_error_estimate, relative_error_bound;
    std::optional<double> error_p99;  ///< What the error is below on 99% of the area, relative like the estimate.
    std::optional<double> relative_error_estimate_interpolant;  ///< Of what `export` writes; likewise.
    std::vector<RoomError> rooms;                               ///< The largest first; one, where all is one room.
    std::optional<double> relative_error_estimate_worst_room;   ///< Of what `probe` evaluates.
    std::vector<BodyError> bodies;                              ///< The largest first; none where nothing was measured.
    std::optional<double> relative_error_estimate_worst_body;   ///< Of what `probe` evaluates.
    std::vector<FaceError> surface_errors;                      ///< One a face; none where nothing was measured.
    /// Relative RMS standard error of the light that a random method found on its elements; 0 for other methods.
    double standard_error = 0;
    EnergyBalance energy;
    std::map<std::string, double> seconds;  ///< total, read, mesh, link, solve, certify, reconstruct, write
    std::size_t peak_memory_bytes = 0, link_memory_bytes = 0;
    /// Of a hierarchy: elements as far down as links come to them, with their light, and how many there are at each
    /// depth.
    std::size_t element_memory_bytes = 0;
    std::vector<std::size_t> elements_by_level;
    std::vector<std::string> warnings;
    std::optional<DiscontinuityCounts> discontinuity;
    std::map<std::string, double> figures;  ///< What a part has to tell beyond these, by the name of its JSON key.
    std::string stopped_by;                 ///< Empty, or "time limit", "memory limit", "iterations", "interrupt".
};

/// The links of a hierarchy, and the elements that they lead between.
struct KeptLinks {
    ElementFunction elements;     ///< With the indirect irradiance of the method's leaves, W/m^2.
    std::vector<KeptLink> links;  ///< By receiver, then by source; empty where none were to be kept.
};

/// Light everywhere: B(x) = M + rho (E_dir(x) + E_ind(x)). E_dir is evaluated exactly from the scene when asked for,
/// E_ind is `indirect` less `direct_share` times E_dir; `interpolant` stands for both together in files that hold plain
/// elements.
struct Solution {
    Scene scene;
    ElementFunction indirect = {};  ///< E_ind + c E_dir; E_ind is what arrives after at least one reflection.
    Spectrum direct_share = {};     ///< c, a value a band: 0 in most scenes (`find_direct_share`).
    ElementFunction interpolant =
        {};  ///< E_dir + E_ind on elements split until they hold three times the error asked for.
    SolveStatistics statistics = {};
    std::string options = {};  ///< The options in force, as JSON.
    /// True when a method carried the emitters' light through its elements, as asked for: then `indirect` holds all
    /// light that arrives, and nothing is evaluated exactly.
    bool direct_in_elements = false;
    /// All bounces (-1), or direct light alone (0): then `indirect` is zero and without elements below the roots.
    int bounces = -1;
    KeptLinks links = {};  ///< Where they were to be kept.
    /// E_dir + E_ind once more, where the method made such a mesh: then it is what `export` writes, and `interpolant`
    /// follows it by linear triangles, for what needs these.
    SixNodeMesh discontinuity = {};
    /// E_dir as the sum of one mesh per source, if requested. Their sum with the light of the elements is evaluated
    /// where no single mesh is needed; files and pictures of one mesh use `discontinuity`.
    LightFormPointer layers = {};
    /// The light of a method that has a representation of its own (growing cells). With `delivers_own_form` it is
    /// evaluated in place of `indirect`, which is its projection on elements then.
    LightFormPointer own_form = {};
    bool delivers_own_form = false;
};

}  // namespace exitance

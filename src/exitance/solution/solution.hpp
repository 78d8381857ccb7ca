#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/run_seconds.hpp"
#include "exitance/links/kept_link.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solution/light_form.hpp"

namespace exitance {

/// Irradiance as one polynomial per leaf: linear on triangles, bilinear on parallelograms, given by its values at the
/// leaf's corners (Patch::corner). Neighbours may have different values: edges may be sharp. W/m^2.
struct ElementFunction {
    ElementTree tree;
    /// Index of a leaf's first corner in `values`; unused for inner elements.
    Field<ElementId, std::uint32_t> first_value;
    std::vector<std::array<float, bands>> values;

    void add_value(const Spectrum& value);
    /// Value at (u, v) of a leaf. 0 for no element, which a locator returns for a point that is not finite.
    Spectrum at(ElementTree::Place place) const;
};

/// Emitted flux, its destinations, and their difference. All bands together, in the scene's `own_unit`.
struct EnergyBalance {
    double emitted = 0;   ///< int M dA
    double absorbed = 0;  ///< int (1 - rho) E dA
    double escaped = 0;   ///< Part of int B dA that meets no front, estimated by few rays; 0 in closed scenes.
    double defect = 0;    ///< |emitted - absorbed - escaped| / emitted
    std::optional<double> defect_before =
        {};  ///< Defect before the light was scaled to conserve energy; none if unknown.
};

/// Mean light in a room (LightRooms) and its error.
struct RoomError {
    double area = 0;   ///< m^2
    double mean = 0;   ///< Mean reflected radiosity over the room's surfaces and the bands, W/m^2; 0 in the dark.
    double error = 0;  ///< RMS error of radiosity, relative to `reference`.
    /// Light to which the error is relative, W/m^2: `mean`, but at least a small share of the brightest room's mean,
    /// since errors relative to darkness are undefined.
    double reference = 0;
};

/// Mean light of a body (`find_bodies`) and its error.
struct BodyError {
    std::size_t surfaces = 0;  ///< Number of its faces.
    double area = 0;           ///< m^2
    double mean = 0;           ///< Reflected radiosity, mean over its surfaces and the bands, W/m^2.
    /// RMS error of radiosity relative to `mean` or a tenth of its room's mean, whichever is larger; none with fewer
    /// than eight points on the body.
    std::optional<double> error;
    std::size_t points = 0;  ///< Number of points at which the error was measured.
    SurfaceId first;         ///< The first of its faces.
    double at_least = 0;     ///< `error` less its standard error; 0 in solutions that were read from files.
};

/// Error of the light of one input face.
struct FaceError {
    double error = 0;        ///< RMS error of radiosity, relative to the mean reflected radiosity of its room.
    std::size_t points = 0;  ///< Number of measured points; 0 if too few, `error` is then that of the room.
};

/// Statistics of a discontinuity mesh.
struct DiscontinuityCounts {
    /// Numbers of curves by kind; sources and curves that were omitted, as the light changes too little.
    std::size_t d0 = 0, d1 = 0, d2 = 0, eee = 0, left_out = 0;
    std::size_t wedges = 0;
    std::size_t lit = 0, penumbra = 0, umbra = 0;  ///< Numbers of faces between the curves before refinement.
    std::size_t triangles = 0;
    double mean_radius_ratio = 0;
};

/// Why a solve ended before it reached what was requested.
enum class StopReason : std::uint8_t {
    none,       ///< It was not stopped.
    interrupt,  ///< SIGINT, or a stop request of a caller of the library.
    time_limit,
    memory_limit,
    iterations,   ///< All attempts, or iterations of a published form, were used.
    divergence,   ///< Light grew from iteration to iteration.
    unit_limit,   ///< Growing cells had all the units that were requested.
    termination,  ///< SIGTERM.
};
/// Returns the name in files and messages, such as "time limit"; empty for none.
std::string_view name_of(StopReason reason);
/// Returns the reason why a stop was requested: that of its first cause, else the time limit.
StopReason reason_of(const StopRequest& stop);
/// Returns the reason of a name; none for unknown names.
StopReason stop_reason_of(std::string_view name);

/// Resources and results of a solve: the keys of `solve --json` and `stats --json`, in their order.
struct SolveStatistics {
    std::string method, basis, schedule;
    int threads = 1, processes = 1;
    std::size_t surfaces = 0, elements = 0, leaf_elements = 0, links = 0;
    std::size_t rays = 0, form_factors = 0, iterations = 0;
    std::size_t refinement_steps = 0;  ///< Refinements of the delivered light that replaced a new solve.
    bool converged = false;            ///< True if the required error was reached, or none was required.
    double residual = 0;               ///< Residual of the discrete system, relative to its right-hand side.
    /// Error of the light that `probe` evaluates, and an upper bound on it; none if a run was stopped before its first
    /// estimate.
    std::optional<double> relative_error_estimate, relative_error_bound;
    std::optional<double> error_p99;  ///< Error that 99% of the area does not exceed, relative like the estimate.
    /// Error of the exported mesh, relative like the estimate.
    std::optional<double> relative_error_estimate_interpolant;
    std::vector<RoomError> rooms;  ///< In descending order of area; a single one if the scene is one room.
    std::optional<double> relative_error_estimate_worst_room;  ///< Largest error of the `rooms`.
    /// Errors of the bodies, in descending order of area; empty if no error was measured.
    std::vector<BodyError> bodies;
    std::optional<double> relative_error_estimate_worst_body;  ///< Largest error of the `bodies`.
    std::vector<FaceError> surface_errors;                     ///< Error of each face; empty if no error was measured.
    /// Relative RMS standard error of the light on the elements of a Monte Carlo method; 0 for other methods.
    double standard_error = 0;
    EnergyBalance energy;
    RunSeconds seconds;
    std::size_t peak_memory_bytes = 0, link_memory_bytes = 0;
    /// For hierarchies: memory of the elements down to the deepest links, with their light, and the number of these
    /// elements at each depth.
    std::size_t element_memory_bytes = 0;
    std::vector<std::size_t> elements_by_level;
    std::vector<std::string> warnings;
    std::optional<DiscontinuityCounts> discontinuity;
    std::map<std::string, double> figures;  ///< Further results of parts of the solver, by JSON key.
    StopReason stopped_by = StopReason::none;

    bool is_stopped() const { return stopped_by != StopReason::none; }
};

/// Links of a hierarchy and the elements that they connect.
struct KeptLinks {
    ElementFunction elements;     ///< Elements with the indirect irradiance of the method's leaves, W/m^2.
    std::vector<KeptLink> links;  ///< Sorted by receiver, then by source; empty unless requested.
};

/// The light of a scene: B(x) = M + rho (E_dir(x) + E_ind(x)). E_dir is evaluated exactly from the scene on demand;
/// E_ind is `indirect` minus `direct_share` times E_dir. `interpolant` replaces both in files that store plain
/// elements.
struct Solution {
    Scene scene;
    ElementFunction indirect = {};  ///< E_ind + c E_dir; E_ind is the light that arrives after at least one reflection.
    Spectrum direct_share = {};     ///< c, one value per band: 0 in most scenes (`find_direct_share`).
    /// E_dir + E_ind on elements that are refined until its error is at most three times the required one.
    ElementFunction interpolant = {};
    SolveStatistics statistics = {};
    std::string options = {};  ///< Options of the solve, as JSON.
    /// True if a method transported the emitters' light through its elements, as requested: then `indirect` is all
    /// arriving light, and nothing is evaluated exactly.
    bool direct_in_elements = false;
    /// Number of bounces: all (-1), or direct light only (0); then `indirect` is zero, without elements below the
    /// roots.
    int bounces = -1;
    KeptLinks links = {};  ///< Links of the solve; stored only if requested.
    /// E_dir + E_ind on a discontinuity mesh, if the method made one. Then it is exported, and `interpolant`
    /// approximates it by linear triangles for other uses.
    SixNodeMesh discontinuity = {};
    /// E_dir as one mesh per source, if requested. Then `discontinuity` is empty until a single mesh is requested
    /// (`make_requested_mesh`), and `interpolant` follows from the layers and `indirect` (`elements_of_layers`).
    LightFormPointer layers = {};
    /// Light of a method that has a representation of its own (growing cells). If `delivers_own_form`, it is evaluated
    /// instead of `indirect`, which is then its projection on elements.
    LightFormPointer own_form = {};
    bool delivers_own_form = false;
};

}  // namespace exitance

#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/growing_cells/growing_cells.hpp"
#include "exitance/lab/growing_cells/surface_pool.hpp"

namespace exitance {

/// Quantity that the kernel network learns for a ray from y to x.
enum class KernelTarget {
    flow,       ///< G V B(y), W/m^4, a value per band, as published.
    visibility  ///< Visibility V only; the kernel multiplies it by the exact G and B(y).
};

struct KernelNetworkOptions {
    KernelTarget target = KernelTarget::flow;
    std::size_t samples_a_unit = 300;  ///< Samples between two insertions of units.
    double resampled = 0.5;            ///< Share of samples drawn near units with a large resource (accumulated error).
    /// Length that a unit difference of two normals counts as, metres. 0: rays are points of R^6 without normals, as
    /// published.
    double normal_scale = 0;
    /// Share of rays whose source point y is uniform over all surfaces. The others are drawn in proportion to
    /// radiosity.
    double uniform_sources = 0.2;
    /// For flow: kernels are taken between discs of this area instead of points, m^2, so that targets are bounded where
    /// surfaces touch. A network of few units could not fit larger values. 0: points, as published.
    double min_area = 0;
    std::uint64_t seed = 1;
};

/// Point-to-point kernel cos cos / (pi r^2), 1/m^2. It is 0 unless each point is more than `in_plane` metres in front
/// of the other's plane.
double point_kernel(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y, double in_plane = 0);

/// A network of dimension four over rays (x, y). It grows where its error is large, and new samples are drawn there.
/// Deterministic: samples are drawn and traced in batches and learned in order. Source: Bohn's scheme of 2002,
/// described in docs/methods/growing_cells.md.
class KernelNetwork {
  public:
    struct Sample {
        std::uint32_t x = 0, y = 0;  ///< Indices in the pool of the ray's end x and start y.
        bool visible = false;
        bool resampled = false;  ///< True if drawn near a unit with a large resource.
    };

    /// All arguments must outlive this object. `radiosity`: B of every point of the pool, W/m^2; sources are drawn in
    /// proportion to it.
    KernelNetwork(const Stage& stage, const SurfacePool& pool, const KernelNetworkOptions& options,
                  std::span<const Spectrum> radiosity);

    /// Restricts the points where rays may start (y) and end (x). Default: all. Must be called before `grow`.
    void restrict_to(std::function<bool(const SurfacePoint&)> is_receiver,
                     std::function<bool(const SurfacePoint&)> is_source);

    /// Learns samples and inserts units until there are `units` of them, or until `stop` is requested. Returns false if
    /// no samples can be drawn.
    bool grow(std::size_t units, const StopRequest& stop, Progress* progress = nullptr);

    /// Replaces the radiosity, for example after a reflection. It determines all later targets, also those of samples
    /// learned before.
    void renew(std::span<const Spectrum> radiosity);
    /// Learns this many more samples without growing.
    void learn_more(std::size_t samples, const StopRequest& stop);

    /// Fits the outputs to all learned samples by least squares: weights of Gaussians for flow, or a linear map in
    /// position around every unit for visibility.
    void fit();

    /// The outputs found by the delta rule, and a way to restore them after `fit`, so that growth can continue. For
    /// studies.
    std::vector<double> outputs_as_learned() const;
    void restore_outputs(std::span<const double> outputs);

    /// Evaluates the network: flow, or visibility in [0, 1] in every band.
    Spectrum evaluate(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;
    /// Fitted visibility, unbiased in the mean: it may be slightly below 0 or above 1 near shadows. Clamp it only if it
    /// is not summed, since clamping darkens.
    double visibility(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;

    /// Indices in the pool of the ends x of all learned rays.
    std::vector<std::uint32_t> receivers_drawn() const;
    /// Visible share of the samples around a ray, weighted by the units' Gaussians. It is sure if nearly all or nearly
    /// none of them were visible.
    struct Seen {
        double share = 0;
        bool is_sure = false;
    };
    Seen seen(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;

    const GrowingCells& cells() const { return *cells_; }
    std::size_t rays() const { return rays_; }
    std::size_t sample_count() const { return samples_.size(); }
    std::span<const Sample> samples() const { return samples_; }  ///< In the order in which they were learned.
    Point place_x(GrowingCells::Unit u) const;
    Point place_y(GrowingCells::Unit u) const;
    /// Stored size of one unit, bytes: coordinates, width and outputs.
    std::size_t bytes_a_unit() const;

  private:
    static constexpr std::size_t no_unit = 0xffffffffu;

    void draw(std::size_t count, std::vector<Sample>& out);
    std::uint32_t draw_source(double u) const;
    void learn(const Sample& sample);
    void make_cells(std::vector<Sample>& first);
    std::vector<double> coordinates(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;
    std::vector<double> coordinates(const Sample& s) const;
    double kernel(const Sample& s) const;
    Spectrum flow(const Sample& s) const;
    std::size_t outputs() const { return options_.target == KernelTarget::flow ? bands : 1; }
    void fit_flow();
    void fit_maps();

    const Stage& stage_;
    const SurfacePool& pool_;
    KernelNetworkOptions options_;
    std::vector<Spectrum> radiosity_;
    std::vector<double> source_sum_;  ///< Running sum of the density of sources over the pool.
    std::vector<std::uint32_t> receivers_;
    std::function<bool(const SurfacePoint&)> is_receiver_, is_source_;
    std::unique_ptr<GrowingCells> cells_;
    std::vector<Sample> samples_;
    std::vector<std::uint32_t> last_won_;  ///< Per unit: index of the last sample that it won.
    /// Per unit: value, then slopes along the six coordinates, of the linear map. Empty before `fit`.
    std::vector<std::array<double, 7>> maps_;
    std::vector<double> seen_;  ///< Per unit: visible share of the samples around it; -1 if there are none.
    std::size_t rays_ = 0, drawn_ = 0, inserted_ = 0, since_look_ = 0;
};

}  // namespace exitance

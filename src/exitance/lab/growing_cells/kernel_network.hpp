#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/growing_cells/growing_cells.hpp"
#include "exitance/lab/growing_cells/surface_pool.hpp"

namespace exitance {

/// What the kernel network learns of a ray that leads from y to x.
enum class KernelTarget {
    flow,       ///< G V B(y), W/m^4, a value a band: as published.
    visibility  ///< V alone; the analytic G and B(y) are multiplied on where it is used.
};

struct KernelNetworkOptions {
    KernelTarget target = KernelTarget::flow;
    std::size_t samples_a_unit = 300;  ///< Between two insertions.
    double resampled = 0.5;            ///< Share of samples drawn near units of much resource.
    /// What a unit of the difference of two normals counts as, metres: 0 as published, where rays are points of R^6.
    double normal_scale = 0;
    /// Of rays that begin on y: a share over all surfaces alike, the rest by the radiosity there.
    double uniform_sources = 0.2;
    /// Of flow: kernels are taken between discs of this area in place of points, m^2, so that targets are bounded where
    /// surfaces touch; a network of so few units could not follow them further. 0: as published.
    double least_area = 0;
    std::uint64_t seed = 1;
};

/// cos cos / (pi r^2), 1/m^2; 0 where the two do not face each other: where either lies no more than `in_plane` metres
/// in front of the other's plane.
double point_kernel(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y, double in_plane = 0);

/// A network of dimension four over rays (x, y): grows where its answers err, on samples that are drawn anew there.
/// Source: Bohn's scheme of 2002 as docs/growing_cells.md tells it. Deterministic: samples are drawn and traced in
/// batches, learned in order.
class KernelNetwork {
  public:
    struct Sample {
        std::uint32_t x = 0, y = 0;  ///< Where it ends and where it begins, in the pool.
        bool visible = false;
        bool resampled = false;  ///< Drawn near a unit of much resource.
    };

    /// All must outlive it. `radiosity`: B of every point of the pool, W/m^2, which sources are drawn by.
    KernelNetwork(const Stage& stage, const SurfacePool& pool, const KernelNetworkOptions& options,
                  std::span<const Spectrum> radiosity);

    /// Where samples may begin (y) and end (x); before growing. All points to begin with.
    void restrict_to(std::function<bool(const PoolPoint&)> is_receiver,
                     std::function<bool(const PoolPoint&)> is_source);

    /// Learns and inserts until there are so many units, or a stop is asked for. False where no samples can be drawn.
    bool grow(std::size_t units, const StopRequest& stop, Progress* progress = nullptr);

    /// The radiosity has changed, as after a reflection: targets are those of it from now on, those of kept samples
    /// too.
    void renew(std::span<const Spectrum> radiosity);
    /// Learns so many more samples without growing.
    void learn_more(std::size_t samples, const StopRequest& stop);

    /// Outputs by least squares over all samples that were learned: of flow as the Gaussians' weights; of visibility as
    /// a linear map in place around every unit.
    void fit();

    /// Outputs as the delta rule has them, and back to these after a fit: growing goes on from there, for studies.
    std::vector<double> outputs_as_learned() const;
    void restore_outputs(std::span<const double> outputs);

    /// Answers: flow, or visibility in [0, 1] in every band.
    Spectrum evaluate(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;
    /// The same as it was fitted, right in the mean: a little below 0 or above 1 beside shadows. To be cut off only
    /// where it is not summed, since cutting darkens.
    double visibility(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;

    /// Where the rays that were learned arrive, in the pool.
    std::vector<std::uint32_t> receivers_drawn() const;
    /// Of the samples around a place by their weights, which share was visible; sure where all or none of them were.
    struct Seen {
        double share = 0;
        bool is_sure = false;
    };
    Seen seen(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const;

    const GrowingCells& cells() const { return *cells_; }
    std::size_t rays() const { return rays_; }
    std::size_t sample_count() const { return samples_.size(); }
    std::span<const Sample> samples() const { return samples_; }  ///< As they were learned.
    Point place_x(GrowingCells::Unit u) const;
    Point place_y(GrowingCells::Unit u) const;
    /// Of one unit: coordinates, width and outputs, as it would be stored.
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
    std::function<bool(const PoolPoint&)> is_receiver_, is_source_;
    std::unique_ptr<GrowingCells> cells_;
    std::vector<Sample> samples_;
    std::vector<std::uint32_t> last_won_;  ///< By unit: the last sample of which it was the winner.
    /// By unit: value, then slopes along the six places, of the linear map; empty before fit().
    std::vector<std::array<double, 7>> maps_;
    std::vector<double> seen_;  ///< By unit: visible share of the samples around it; -1 for none.
    std::size_t rays_ = 0, drawn_ = 0, inserted_ = 0, since_look_ = 0;
};

}  // namespace exitance

// The local pass on many small elements at once.
#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/direction_order.hpp"
#include "exitance/base/error_share.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/mesh/spatial_order.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

constexpr std::size_t elements_together = 64;  ///< Traced at once: more than 100 packets of 16 rays.
constexpr unsigned first_rays = 32;            ///< Rays of an element at first.

/// The gather of one element, by rays that start all over it: its mean, and the coefficients of the linear polynomials
/// of `ElementPolynomials` that are not constant (those along its two directions).
class PooledGather {
  public:
    static constexpr std::size_t terms = 3;

    PooledGather(const ElementTree& tree, ElementId e, std::uint64_t seed)
        : e_(e),
          polynomials_(tree, e, element_rule(tree, e, RuleOrder::fine), false),
          points_(hash(seed, static_cast<std::uint64_t>(Stream::gather), e.value)) {}

    ElementId element() const { return e_; }
    unsigned rays() const { return of_[0].rays(); }
    const ScrambledSobol& points() const { return points_; }
    ElementPolynomials::Values at(Vec2 uv) const { return polynomials_.at(uv); }
    void add(std::size_t term, const QuarterSums& sums, unsigned rays) { of_[term].add(sums, rays); }
    Gathered term(std::size_t k) const { return of_[k].gathered(); }

  private:
    ElementId e_;
    ElementPolynomials polynomials_;
    ScrambledSobol points_;
    std::array<GrowingGather, terms> of_;
};

/// Casts rays of many elements together.
class RaysTogether {
  public:
    RaysTogether(const Stage& stage, const ElementTree& tree, const ReflectedLight& b)
        : stage_(stage), tree_(tree), b_(b) {}

    /// Gives each element `first_rays`, or doubles its rays.
    void grow(std::span<PooledGather* const> elements) {
        clear();
        for (std::size_t i = 0; i < elements.size(); ++i) choose(*elements[i], static_cast<std::uint32_t>(i));
        trace();
        sums_.assign(elements.size(), {});
        for (std::size_t k = 0; k < fronts_.size(); ++k) {
            const Ray& ray = rays_[share_[k]];
            for (std::size_t term = 0; term < PooledGather::terms; ++term)
                sums_[ray.element][term][ray.quarter] += ray.phi[term] * values_[k];
        }
        for (std::size_t i = 0; i < elements.size(); ++i) {
            const unsigned before = elements[i]->rays(), more = before == 0 ? first_rays : before;
            for (std::size_t term = 0; term < PooledGather::terms; ++term) elements[i]->add(term, sums_[i][term], more);
        }
    }

    /// True if a start of the last rays of element i is covered or inside a body.
    bool is_partly_hidden(std::size_t i) const { return hidden_[i] != 0; }

  private:
    struct Ray {
        std::uint32_t element = 0;
        std::uint32_t quarter = 0;
        std::array<double, PooledGather::terms> phi;
    };

    void clear() { rays_.clear(), starts_.clear(), directions_.clear(); }

    void choose(const PooledGather& of, std::uint32_t number) {
        const unsigned before = of.rays(), more = before == 0 ? first_rays : before;
        const ElementId e = of.element();
        const RegionId region = tree_.region(e);
        const Patch patch = tree_.patch(e);
        for (int d = 0; d < 4; ++d) {
            std::vector<double>& x = coordinates_[static_cast<std::size_t>(d)];
            x.resize(more);
            of.points().fill(before, d, x);
        }
        const std::size_t first = directions_.size();
        directions_.resize(first + more);
        cosine_directions(Frame(stage_.scene.regions()[region].plane.n), coordinates_[0], coordinates_[1],
                          std::span(directions_).subspan(first));
        for (std::uint32_t k = 0; k < more; ++k) {
            const Vec2 uv = tree_.uniform(e, coordinates_[2][k], coordinates_[3][k]);
            const ElementPolynomials::Values phi = of.at(uv);
            rays_.push_back({number, 4 * k / more, {phi[0], phi[1], phi[2]}});
            starts_.push_back({patch.at(uv), region});
        }
    }

    void trace() {
        const std::span<const std::uint32_t> order = order_.sort(directions_);
        sorted_starts_.clear(), sorted_directions_.clear();
        for (const std::uint32_t i : order)
            sorted_starts_.push_back(starts_[i]), sorted_directions_.push_back(directions_[i]);
        hits_.resize(sorted_starts_.size());
        stage_.tracer.nearest(sorted_starts_, sorted_directions_, hits_, Mirrored::followed);
        fronts_.clear(), share_.clear(), colours_.clear();
        hidden_.assign(rays_.empty() ? 0 : rays_.back().element + 1, 0);
        for (std::size_t k = 0; k < order.size(); ++k) {
            const RayHit& hit = hits_[k];
            if (hit.surface.is_none()) continue;
            if (!hit.front) {
                look_around(rays_[order[k]].element, sorted_starts_[k]);
                continue;
            }
            fronts_.push_back({place_of(stage_.scene, hit, sorted_starts_[k].x, sorted_directions_[k]), hit.region});
            share_.push_back(order[k]);
            if (!stage_.glass.empty())
                colours_.push_back(stage_.glass.of(hit, sorted_starts_[k].x, sorted_directions_[k]));
        }
        values_.resize(fronts_.size());
        b_.read(fronts_, values_);
        for (std::size_t k = 0; k < colours_.size(); ++k) values_[k] *= colours_[k];
    }

    /// Tests whether the start of a ray that hit a back is hidden. Does nothing if a hidden start of the element was
    /// found before.
    void look_around(std::uint32_t element, const RayEnd& start) {
        std::uint8_t& hidden = hidden_[element];
        if (hidden != 0) return;
        hidden = !is_in_open(stage_, start.x, stage_.scene.regions()[start.region].plane.n, start.region);
    }

    const Stage& stage_;
    const ElementTree& tree_;
    const ReflectedLight& b_;
    std::vector<Ray> rays_;
    std::vector<RayEnd> starts_, sorted_starts_;
    std::vector<Vec3> directions_, sorted_directions_;
    std::array<std::vector<double>, 4> coordinates_;
    DirectionOrder order_;
    std::vector<RayHit> hits_;
    std::vector<RayEnd> fronts_;
    std::vector<std::uint32_t> share_;  ///< Entry of `rays_` for each front.
    std::vector<Spectrum> colours_;     ///< Factors of panes on each front's bands; empty: all are 1.
    std::vector<Spectrum> values_;
    std::vector<std::array<QuarterSums, PooledGather::terms>> sums_;  ///< Per element.
    std::vector<std::uint8_t> hidden_;                                ///< Per element.
};

Spectrum squares(const Spectrum& s) {
    return s * s;
}

/// Polynomial of the gathered terms. Those that are not constant are shrunk according to their noise: on
/// small elements they are hardly more than noise. `slope_squared`: mean square of the slope.
SampledElement as_sampled(const PooledGather& of, const Spectrum& rho, double gain, double& slope_squared) {
    SampledElement out;
    const Gathered mean_of = of.term(0);
    out.quarters = mean(rho * rho * mean_of.quarters), out.halves = mean(rho * rho * mean_of.halves);
    out.noise_squared = gain * out.quarters;
    double slopes = 0, noise = 0;
    std::array<Gathered, PooledGather::terms> term;
    for (std::size_t k = 1; k < PooledGather::terms; ++k) {
        term[k] = of.term(k);
        slopes += mean(squares(rho * term[k].irradiance)), noise += mean(rho * rho * term[k].quarters);
    }
    slope_squared =
        std::max(0.0, slopes - 3 * noise);  // derived from two slopes: noise exceeds it once in twenty times
    const double kept = slopes > noise ? 1 - noise / slopes : 0, lost = 1 - kept;
    out.noise_squared += kept * kept * noise + lost * lost * std::max(0.0, slopes - noise);
    out.light = std::sqrt(mean(squares(rho * mean_of.irradiance)) + kept * kept * slopes);
    out.coefficient = {};
    for (std::size_t k = 0; k < PooledGather::terms; ++k)
        for (std::size_t b = 0; b < bands; ++b)
            out.coefficient[k][b] = static_cast<float>(k == 0 ? mean_of.irradiance[b] : kept * term[k].irradiance[b]);
    out.rays = of.rays();
    // The rays count as if they belonged to one place: all of them are stratified together.
    out.place_rays = of.rays();
    return out;
}

}  // namespace

/// True if an element of a crowd may be gathered together with others: it is small and whole, rays are not aimed from
/// there, and the light of its two sides is not mixed.
bool LocalPass::is_minor(ElementId e, double small_area, const ReflectedLight& b) const {
    const RegionId region = tree_.region(e);
    if (tree_.area(e) > small_area || tree_.is_cell(e) || !stage_.scene.behind(region).is_none()) return false;
    const Normal& n = stage_.scene.regions()[region].plane.n;
    const Point x = tree_.patch(e).at(tree_.centre(e));
    if (const BrightPlaces* bright = b.bright_places())
        return worth_aiming(stage_, region, bright->of_room(stage_.rooms.at(region, x)), x, n).empty();
    return portals_worth_aiming(stage_, region, x, n).empty();
}

std::vector<ElementId> LocalPass::gather_together(const std::vector<ElementId>& active, const ReflectedLight& b,
                                                  const LocalPassDemand& demand, LocalPassReport& report,
                                                  Progress& progress, const StopRequest& stop) {
    std::vector<ElementId> small, rest;
    const double small_area = stage_.small_area(active.size());
    for (const ElementId e : active) (is_minor(e, small_area, b) ? small : rest).push_back(e);
    if (small.size() < elements_together) return active;
    sort_by_place(tree_, small);
    sampled_.resize(tree_.size());
    for (const ElementId e : small) sampled_[e] = {};
    const auto sample_block = [&](std::span<const ElementId> block) {
        std::vector<PooledGather> all;
        all.reserve(block.size());
        std::vector<PooledGather*> open;
        for (const ElementId e : block) open.push_back(&all.emplace_back(tree_, e, seed_));
        RaysTogether rays(stage_, tree_, b);
        while (!open.empty()) {
            rays.grow(open);
            std::vector<PooledGather*> further;
            for (std::size_t i = 0; i < open.size(); ++i) {
                if (rays.is_partly_hidden(i)) continue;
                const ElementId e = open[i]->element();
                double slope_squared = 0;
                const SampledElement found = as_sampled(*open[i], stage_.scene.material(tree_.region(e)).reflectance,
                                                        spread_.gain(), slope_squared);
                const double allowed = allowed_misfit(e, found.light, demand);
                if (slope_squared > allowed * allowed) continue;
                if (noise_excess(e, found, demand) <= calibrated::tolerated_noise ||
                    2 * found.place_rays > demand.rays.max)
                    sampled_[e] = found;
                else
                    further.push_back(open[i]);
            }
            open = std::move(further);
        }
    };
    // In slices, so that progress can be reported, and so that the gain of stratified rays is known from the second on.
    constexpr std::size_t slices = 16;
    const std::size_t blocks = (small.size() + elements_together - 1) / elements_together;
    const std::size_t slice = ((blocks + slices - 1) / slices) * elements_together;
    for (std::size_t first = 0; first < small.size() && !stop.requested(); first += slice) {
        const auto of_slice = std::span<const ElementId>(small).subspan(first, std::min(slice, small.size() - first));
        shared_ranges_of(
            sampled_.span(), of_slice.size(), elements_together,
            [&](std::size_t begin, std::size_t end) {
                if (!stop.requested()) sample_block(of_slice.subspan(begin, end - begin));
            },
            [&](std::size_t i) -> SampledElement& { return sampled_[of_slice[i]]; },
            {"gather", [&](std::size_t i) { return tree_.region(of_slice[i]).value; }});
        for (const ElementId e : of_slice) {
            spread_.quarters += tree_.area(e) * sampled_[e].quarters;
            spread_.halves += tree_.area(e) * sampled_[e].halves;
        }
        progress.advance(0.5 * static_cast<double>(first) / static_cast<double>(small.size()));
    }
    report.rays += rays_of(small);
    for (const ElementId e : small)
        if (sampled_[e].place_rays == 0) rest.push_back(e);
    return rest;
}

}  // namespace exitance

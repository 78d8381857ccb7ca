#include "exitance/lab/studies/kernel_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <queue>
#include <string>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/lab/growing_cells/kernel_network.hpp"

namespace exitance {
namespace {

struct Pair {
    SurfacePoint x, y;
    Spectrum truth;
    double kernel;
};

/// Draws new pairs of points for measurements, with the exact kernel.
std::vector<Pair> make_pairs(const Stage& stage, std::size_t count, bool of_emitters, std::uint64_t seed) {
    std::vector<Piece> from, to;
    const auto emits = [&](const Piece& p) { return stage.scene.material(p.region).emits(); };
    for (const Piece& piece : stage.lit_pieces()) {
        if (of_emitters || !emits(piece)) from.push_back(piece);
        if (emits(piece) == of_emitters) to.push_back(piece);
    }
    RandomStream random(seed, Stream::reference, 27, of_emitters);
    const auto draw = [&](const std::vector<Piece>& pieces) {
        double total = 0;
        for (const Piece& p : pieces) total += p.patch.area();
        double left = random.uniform() * total;
        std::size_t i = 0;
        while (i + 1 < pieces.size() && left >= pieces[i].patch.area()) left -= pieces[i].patch.area(), ++i;
        const double s = random.uniform(), t = random.uniform();
        return SurfacePoint{pieces[i].patch.at(uniform_in_shape(pieces[i].patch.shape, s, t)),
                            stage.scene.regions()[pieces[i].region].plane.n, pieces[i].region};
    };
    std::vector<Pair> out;
    std::vector<RayEnd> a, b;
    for (std::size_t tries = 0; out.size() < count && tries < 100 * count; ++tries) {
        Pair p{draw(from), draw(to), {}, 0};
        p.kernel = point_kernel(p.x.x, p.x.n, p.y.x, p.y.n);
        if (!(p.kernel > 0)) continue;
        out.push_back(p);
        a.push_back({p.x.x, p.x.region}), b.push_back({p.y.x, p.y.region});
    }
    const std::unique_ptr<bool[]> blocked(new bool[out.size()]);
    if (!out.empty()) stage.tracer.occluded(a, b, {blocked.get(), out.size()});
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Spectrum M = of_emitters ? stage.scene.material(out[i].y.region).exitance : Spectrum(1);
        out[i].truth = (blocked[i] ? 0.0 : out[i].kernel) * M;
    }
    return out;
}

template <class Answer>
double error_of(const std::vector<Pair>& pairs, bool squares, const Answer& answer) {
    struct Sums {
        double off = 0, all = 0;
        Sums& operator+=(const Sums& o) { return off += o.off, all += o.all, *this; }
    };
    const Sums sums = parallel_sum<Sums>(pairs.size(), [&](std::size_t i) {
        const Spectrum d = answer(pairs[i]) - pairs[i].truth;
        return squares ? Sums{squared(d), squared(pairs[i].truth)} : Sums{std::abs(mean(d)), mean(pairs[i].truth)};
    });
    if (!(sums.all > 0)) return 0;
    return squares ? std::sqrt(sums.off / sums.all) : sums.off / sums.all;
}

/// Links between elements, refined in the order of the light that they transport.
class LinkedKernel {
  public:
    LinkedKernel(const Stage& stage, bool of_emitters, std::uint64_t seed) : stage_(stage), seed_(seed) {
        const auto pieces = stage.lit_pieces();
        for (const Piece& piece : pieces) elements_.push_back({piece.region, piece.patch, {}});
        for (std::uint32_t x = 0; x < pieces.size(); ++x)
            for (std::uint32_t y = 0; y < pieces.size(); ++y) {
                const bool emits = stage.scene.material(pieces[y].region).emits();
                if (x == y || emits != of_emitters) continue;
                if (!of_emitters && stage.scene.material(pieces[x].region).emits()) continue;
                add(x, y, of_emitters ? mean(stage.scene.material(pieces[y].region).exitance) : 1);
            }
        roots_ = links_.size();
    }
    /// Splits links until there are `count`. Links between elements that do not face each other are not split.
    void refine(std::size_t count) {
        while (alive_ < count && !queue_.empty() && queue_.top().first > 0) {
            const std::uint32_t at = queue_.top().second;
            queue_.pop();
            const auto [x, y] = std::pair(links_[at].x, links_[at].y);
            const bool cut_x = elements_[x].patch.area() >= elements_[y].patch.area();
            const std::uint32_t first = split(cut_x ? x : y);
            links_[at].first = static_cast<std::uint32_t>(links_.size());
            links_[at].cut_x = cut_x;
            --alive_;
            for (std::uint32_t i = 0; i < 4; ++i) add(cut_x ? first + i : x, cut_x ? y : first + i, links_[at].light);
        }
    }
    std::size_t count() const { return alive_; }
    double operator()(const Pair& p) const {
        for (std::uint32_t l = 0; l < roots_; ++l) {
            const Element &x = elements_[links_[l].x], &y = elements_[links_[l].y];
            if (!holds(x, p.x) || !holds(y, p.y)) continue;
            std::uint32_t at = l;
            while (links_[at].first != none) {
                const std::uint32_t first = links_[at].first;
                std::uint32_t child = 0;
                double best = -1e9;
                for (std::uint32_t i = 0; i < 4; ++i) {
                    const Link& c = links_[first + i];
                    const double in =
                        inside(elements_[links_[at].cut_x ? c.x : c.y].patch, links_[at].cut_x ? p.x.x : p.y.x);
                    if (in > best) best = in, child = i;
                }
                at = first + child;
            }
            return links_[at].value;
        }
        return 0;
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Element {
        RegionId region;
        Patch patch;
        std::optional<std::uint32_t> children;
    };
    struct Link {
        std::uint32_t x, y;
        double value, light;
        std::uint32_t first = none;
        bool cut_x = false;
    };

    static double inside(const Patch& patch, const Point& p) {
        const Vec2 uv = patch.coordinates(p);
        return patch.is_triangle() ? std::min({uv.x, uv.y, 1 - uv.x - uv.y})
                                   : std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y});
    }
    static bool holds(const Element& e, const SurfacePoint& p) {
        return e.region == p.region && inside(e.patch, p.x) > -1e-9;
    }
    std::uint32_t split(std::uint32_t e) {
        if (elements_[e].children) return *elements_[e].children;
        const auto first = static_cast<std::uint32_t>(elements_.size());
        const RegionId region = elements_[e].region;
        for (const Patch& part : cut(elements_[e].patch, Cut::both)) elements_.push_back({region, part, {}});
        elements_[e].children = first;
        return first;
    }
    void add(std::uint32_t x, std::uint32_t y, double light) {
        const Patch &a = elements_[x].patch, &b = elements_[y].patch;
        const Normal n_x = a.normal(), n_y = b.normal();
        constexpr int side = 4;
        double kernel = 0, seen = 0;
        std::vector<Point> from, to;
        RandomStream random(seed_, Stream::visibility, x, y);
        for (int i = 0; i < side * side; ++i) {
            const double s = (i % side + random.uniform()) / side, t = (i / side + random.uniform()) / side;
            from.push_back(a.at(uniform_in_shape(a.shape, s, t)));
            const int j = (7 * i + 3) % (side * side);
            const double u = (j % side + random.uniform()) / side, v = (j / side + random.uniform()) / side;
            to.push_back(b.at(uniform_in_shape(b.shape, u, v)));
            kernel += point_kernel(from.back(), n_x, to.back(), n_y) / (side * side);
        }
        if (kernel > 0) {
            bool blocked[side * side];
            stage_.tracer.occluded(from, to, elements_[x].region, elements_[y].region, blocked);
            for (const bool hidden : blocked) seen += hidden ? 0 : 1.0 / (side * side);
        }
        links_.push_back({x, y, kernel * seen, light, none, false});
        // B F A: light that the link transports.
        queue_.emplace(light * kernel * seen * a.area() * b.area(), static_cast<std::uint32_t>(links_.size() - 1));
        ++alive_;
    }

    const Stage& stage_;
    std::uint64_t seed_;
    std::vector<Element> elements_;
    std::vector<Link> links_;
    std::priority_queue<std::pair<double, std::uint32_t>> queue_;
    std::size_t roots_ = 0, alive_ = 0;
};

void study(const Stage& stage, std::uint64_t seed, const std::vector<std::size_t>& counts, std::size_t pair_count,
           bool of_emitters, const std::string& scene, CsvText& out, const StopRequest& stop) {
    const std::vector<Pair> pairs = make_pairs(stage, pair_count, of_emitters, seed + 1000);
    const auto emission = [&](const Pair& p) {
        return of_emitters ? stage.scene.material(p.y.region).exitance : Spectrum(1);
    };
    const auto print_row = [&](const char* row, std::size_t asked, std::size_t n, double error, std::size_t bytes,
                               double seconds) {
        out.print("%s,%s,%s,%llu,%zu,%zu,%.5g,%zu,%.3f\n", scene.c_str(), of_emitters ? "light" : "touching", row,
                  static_cast<unsigned long long>(seed), asked, n, error, bytes, seconds);
    };
    LinkedKernel links(stage, of_emitters, seed);
    for (const std::size_t n : counts) {
        const Stopwatch watch;
        links.refine(n);
        // A link stores the numbers of two elements and its factor.
        print_row("links", n, links.count(),
                  error_of(pairs, of_emitters, [&](const Pair& p) { return links(p) * emission(p); }),
                  links.count() * 16, watch.seconds());
    }
    const SurfacePool pool(stage, 1 << 15, seed);
    std::vector<Spectrum> light;
    for (const SurfacePoint& p : pool.points())
        light.push_back(of_emitters ? stage.scene.material(p.region).exitance : Spectrum(1));
    const auto emits = [&](const SurfacePoint& p) { return stage.scene.material(p.region).emits(); };
    for (const KernelTarget target : {KernelTarget::flow, KernelTarget::visibility}) {
        const bool flow = target == KernelTarget::flow;
        KernelNetwork network(stage, pool,
                              {.target = target,
                               .normal_scale = flow ? 0 : 0.5 * stage.scene.size(),
                               .uniform_sources = of_emitters ? 0.0 : 1.0,
                               .seed = seed},
                              light);
        network.restrict_to([&](const SurfacePoint& p) { return of_emitters || !emits(p); },
                            [&](const SurfacePoint& p) { return emits(p) == of_emitters; });
        double grown = 0;
        for (const std::size_t n : counts) {
            Stopwatch watch;
            if (!network.grow(n, stop)) return;
            grown += watch.restart();
            const auto answer = [&](const Pair& p) {
                const Spectrum a = network.evaluate(p.x.x, p.x.n, p.y.x, p.y.n);
                return flow ? a : a * (p.kernel * emission(p));
            };
            const std::size_t bytes = network.bytes_a_unit() * network.cells().unit_count();
            if (flow) print_row("cells delta rule", n, n, error_of(pairs, of_emitters, answer), bytes, grown);
            watch.restart();
            KernelNetwork* fitted = &network;
            const std::vector<double> kept = network.outputs_as_learned();
            fitted->fit();
            const double fit_seconds = watch.seconds();
            print_row(flow ? "cells least squares" : "cells improved", n, network.cells().unit_count(),
                      error_of(pairs, of_emitters, answer), bytes, grown + fit_seconds);
            network.restore_outputs(kept);
        }
    }
}

}  // namespace

void measure_kernel_error(const std::string& name, const Scene& scene, const KernelErrorOptions& options, CsvText& out,
                          const StopRequest& stop) {
    const Stage stage(scene);
    for (std::uint64_t seed = 1; seed <= options.seeds; ++seed)
        for (const bool of_emitters : {true, false})
            if ((of_emitters || seed == 1) && !stop.requested())
                study(stage, seed, options.counts, options.pairs, of_emitters, name, out, stop);
}

}  // namespace exitance

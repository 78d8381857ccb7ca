#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/links/links.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {
namespace {

/// A closed box with faces of 1 m x 1 m, fronts inwards.
Scene make_box() {
    SceneDescription d;
    d.file = "box.obj";
    d.groups = {"box"};
    d.materials = {{"wall", Spectrum(0.5), Spectrum(1.0)}};
    for (const double z : {0.0, 1.0}) d.points.insert(d.points.end(), {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                           {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::size_t i = 0; i < faces.size(); ++i) d.faces.push_back({faces[i], 0, 0, static_cast<int>(i + 1)});
    return std::move(*make_scene(std::move(d)).scene);
}

/// Elements of a box, and `count` links between the leaves of its faces.
struct Linked {
    Scene scene = make_box();
    Stage stage{scene};
    ElementTree tree;
    NodalBasis basis;
    LinkSites sites;
    NodalField b, E;
    Links links;

    /// Links every receiver to adjacent elements, as is typical of elements with similar visibility. A share `hidden`
    /// of the pairs of nodes is not visible.
    Linked(HierarchyBasis kind, double edge, std::size_t count, double hidden)
        : tree(stage.make_elements({edge, 0})),
          basis(kind),
          sites(stage, tree, basis),
          b(sites),
          E(sites),
          links(make_links(count, hidden)) {
        for (ElementId e : tree.ids())
            for (std::size_t k = 0; k < sites.nodes(); ++k) b.set_node(e, k, Spectrum(1 + 1e-3 * double(e.value % 7)));
    }

    Links make_links(std::size_t count, double hidden) {
        const std::vector<ElementId> leaves = tree.leaves();
        const std::size_t each = count / leaves.size();
        RandomStream random(1, Stream::mesh);
        std::vector<Link> out;
        out.reserve(leaves.size() * each);
        for (ElementId p : leaves) {
            std::vector<ElementId> others;
            auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(leaves.size()));
            while (others.size() < each) {
                at = (at + 1 + static_cast<std::size_t>(3 * random.uniform())) % leaves.size();
                if (tree.region(leaves[at]) != tree.region(p)) others.push_back(leaves[at]);
            }
            for (ElementId q : others) {
                Link link;
                link.receiver = p, link.source = q;
                if (sites.nodes() == 1) {
                    link.factor = 1e-3f;
                } else {
                    link.set_far(1);
                    for (std::size_t bit = 0; bit < sites.nodes() * sites.nodes(); ++bit)
                        if (random.uniform() >= hidden) link.set(bit);
                }
                out.push_back(link);
            }
        }
        return Links(sites, std::move(out), {});
    }
};

}  // namespace

/// Memory bandwidth: a = b + s c on arrays far larger than the caches, on all threads; bytes counted as in STREAM.
static void stream_triad(benchmark::State& state) {
    set_threads(static_cast<int>(state.range(0)));
    const std::size_t n = 16'000'000;
    std::vector<double> a(n), b(n, 1.0), c(n, 2.0);
    for (auto _ : state) {
        parallel_ranges(n, 1 << 18, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) a[i] = b[i] + 3.0 * c[i];
        });
        benchmark::DoNotOptimize(a.data());
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(24 * n));
    set_threads(0);
}
BENCHMARK(stream_triad)->Arg(1)->Arg(2)->UseRealTime();

/// Stored constant links: bandwidth of reading the links, 8 bytes each, to be compared with stream_triad.
static void gather_constant_links(benchmark::State& state) {
    Linked linked(HierarchyBasis::haar, 1.0 / static_cast<double>(state.range(2)),
                  static_cast<std::size_t>(state.range(1)), 0);
    set_threads(static_cast<int>(state.range(0)));
    for (auto _ : state) linked.links.gather(linked.b, linked.E);
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(linked.links.memory_bytes()));
    state.counters["links"] = static_cast<double>(linked.links.size());
    state.counters["ns_a_link"] =
        benchmark::Counter(static_cast<double>(linked.links.size()) * 1e-9,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    set_threads(0);
}
BENCHMARK(gather_constant_links)
    ->ArgsProduct({{1, 2}, {1'000'000, 10'000'000, 30'000'000}, {31, 127}})
    ->ArgNames({"threads", "links", "edge"})
    ->UseRealTime();

/// Links whose kernels are recomputed, with visibility masks: nanoseconds per link on one core.
static void gather_kernel_links(benchmark::State& state) {
    const auto kind = state.range(0) == 2 ? HierarchyBasis::multiwavelet2 : HierarchyBasis::multiwavelet3;
    Linked linked(kind, 1.0 / 31, static_cast<std::size_t>(state.range(1)), 0.2);
    set_threads(1);
    for (auto _ : state) linked.links.gather(linked.b, linked.E);
    state.counters["ns_a_link"] =
        benchmark::Counter(static_cast<double>(linked.links.size()) * 1e-9,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    set_threads(0);
}
BENCHMARK(gather_kernel_links)->ArgsProduct({{2, 3}, {100'000, 1'000'000, 10'000'000}})->ArgNames({"order", "links"});

}  // namespace exitance

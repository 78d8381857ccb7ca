#include "exitance/lab/studies/sample_distribution.hpp"

#include "exitance/lab/growing_cells/kernel_network.hpp"

namespace exitance {

void write_sample_distribution(const std::string& name, const Scene& scene, const std::vector<std::size_t>& units,
                               std::size_t samples, std::uint64_t seed, CsvText& out, const StopRequest& stop) {
    const Stage stage(scene);
    constexpr std::size_t points = 1 << 15;
    const SurfacePool pool(stage, points, seed);
    std::vector<Spectrum> light;
    for (const SurfacePoint& p : pool.points()) light.push_back(scene.material(p.region).exitance);
    KernelNetwork network(stage, pool, {.target = KernelTarget::flow, .uniform_sources = 0, .seed = seed}, light);
    network.restrict_to([](const SurfacePoint&) { return true; },
                        [&](const SurfacePoint& p) { return scene.material(p.region).emits(); });
    for (const std::size_t count : units) {
        if (!network.grow(count, stop)) return;
        const auto drawn = network.samples();
        for (const KernelNetwork::Sample& s : drawn.last(std::min(samples, drawn.size()))) {
            const Point &x = pool[s.x].x, &y = pool[s.y].x;
            out.print("%s,%zu,%d,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", name.c_str(), count, int(s.resampled),
                      int(s.visible), x.x, x.y, x.z, y.x, y.y, y.z);
        }
    }
}

}  // namespace exitance

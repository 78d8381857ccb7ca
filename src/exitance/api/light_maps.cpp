#include "exitance/light_maps.hpp"

#include <cmath>

#include "exitance/api/inside.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance::api {

struct LightMapsData {
    exitance::LightMaps maps;
    Solution solution;
};

double LightMaps::density() const {
    return data_->maps.density;
}

std::size_t LightMaps::size() const {
    return data_->maps.maps.size();
}

LightMap LightMaps::map(std::size_t index) const {
    const exitance::LightMap& map = data_->maps.maps[index];
    return {map.size.width, map.size.height, map.irradiance, map.share};
}

std::vector<Chart> LightMaps::charts() const {
    const exitance::Scene& scene = data_->solution.data().solution.scene;
    std::vector<Chart> out;
    for (const exitance::Chart& c : data_->maps.charts) {
        Chart chart{c.map, c.x, c.y, c.width, c.height, to_api(c.origin), to_api(c.du), to_api(c.dv), {}};
        for (const SurfaceId s : scene.regions()[c.region].surfaces) chart.faces.push_back(s.value);
        out.push_back(std::move(chart));
    }
    return out;
}

Result<void> LightMaps::save(const std::string& folder) const {
    return take_turn<void>([&] {
        const exitance::Solution& solution = data_->solution.data().solution;
        LightMapFormat format;
        format.scene_file = find_scene_file(solution.scene, "");
        return to_api(write_light_maps(solution, data_->maps, format, {}, folder));
    });
}

Result<LightMaps> bake(const Solution& solution, const BakeOptions& options, const Control& control) {
    return take_turn<LightMaps>(control, [&](Run& run) -> Result<LightMaps> {
        constexpr int most_padding = 1024;
        if (!(options.density >= 0) || !std::isfinite(options.density))
            return usage("must be above 0 texels per metre, or 0 for an automatic choice", "density");
        if (options.padding < 1 || options.padding > most_padding)
            return usage("must be from 1 to 1024 texels", "padding");
        exitance::BakeOptions in;
        in.density = options.density, in.padding = options.padding;
        exitance::Result<exitance::LightMaps> maps =
            bake_light_maps(solution.data().light(), in, run.progress(), run.stop());
        if (!maps) return to_api(maps.error());
        if (run.stop().requested()) return stopped("baking");
        return LightMaps(std::make_shared<const LightMapsData>(LightMapsData{std::move(*maps), solution}));
    });
}

}  // namespace exitance::api

#include "exitance/io/export/light_map_files.hpp"

#include <gtest/gtest.h>

#include "exitance/io/export/directional_files.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "support/hdr_pixels.hpp"
#include "support/sample_solution.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {

TEST(LightMapFiles, HdrPicturesHoldTheMapsWithinTheirPrecision) {
    const TemporaryFolder folder;
    const Solution solution = sample_solution();
    Progress progress;
    const StopRequest stop;
    BakeOptions options;
    options.density = 12, options.component = Component::direct;
    const Result<LightMaps> maps = bake_light_maps(RadiosityFunction(solution), options, progress, stop);
    ASSERT_TRUE(maps);
    LightMapFormat format;
    format.component = options.component, format.with_hdr = true;
    ASSERT_TRUE(write_light_maps(solution, *maps, format, {}, folder / "maps"));
    const MapSize size = maps->maps[0].size;
    const Result<std::string> hdr = read_whole_file(folder / "maps/lightmap_0.hdr"),
                              manifest = read_whole_file(folder / "maps/lightmaps.json");
    ASSERT_TRUE(hdr && manifest);
    EXPECT_NE(hdr->find("# units: R, G, B: direct irradiance in W/m^2"), std::string::npos);
    EXPECT_NE(manifest->find("\"component\": \"direct\""), std::string::npos);
    EXPECT_NE(manifest->find("\"hdr\": \"lightmap_0.hdr\""), std::string::npos);
    const auto pixels = read_hdr(*hdr, static_cast<std::size_t>(size.width), static_cast<std::size_t>(size.height));
    std::size_t bright = 0;
    for_each_texel(*maps, 0, [&](const Chart& chart, std::size_t i) {
        const auto rgb = red_green_blue(texel_value(solution.scene, maps->maps[0], chart, i, format.quantity));
        const double brightest = std::max({rgb[0], rgb[1], rgb[2]});
        bright += brightest > 0;
        for (std::size_t c = 0; c < 3; ++c)  // tolerance: half a step of the mantissa, which is at least 128
            EXPECT_NEAR(pixels[i][c], std::max(0.0, rgb[c]), brightest / 256 * 1.0001);
    });
    EXPECT_GT(bright, 100u);
}

TEST(LightMapFiles, TheEmissionOfLampsIsDirectLight) {
    const Scene scene = sample_scene();
    const SurfaceId lamp(3);
    Chart chart;
    chart.region = scene.surfaces()[lamp].region;
    LightMap map;
    map.irradiance = {{}};
    EXPECT_EQ(texel_value(scene, map, chart, 0, LightMapQuantity::radiosity), scene.material(lamp).exitance);
    EXPECT_GT(mean(scene.material(lamp).exitance), 0);
    map.has_emission = false;
    EXPECT_EQ(texel_value(scene, map, chart, 0, LightMapQuantity::radiosity), Spectrum());
}

TEST(LightMapFiles, DirectionsHaveFilesOfTheirOwn) {
    const TemporaryFolder folder;
    const Solution solution = sample_solution();
    Progress progress;
    const StopRequest stop;
    for (const Directions form : {Directions::sh, Directions::dominant}) {
        BakeOptions options;
        options.density = 4, options.directions = form;
        const Result<LightMaps> maps = bake_light_maps(RadiosityFunction(solution), options, progress, stop);
        ASSERT_TRUE(maps);
        LightMapFormat format;
        format.directions = form;
        const std::vector<std::string> groups{"lamp"};
        ASSERT_TRUE(write_group_light_maps(solution.scene, *maps, 0, format, folder / "maps"));
        ASSERT_TRUE(write_light_maps(solution, *maps, format, groups, folder / "maps"));
        const Result<std::string> manifest = read_whole_file(folder / "maps/lightmaps.json");
        ASSERT_TRUE(manifest);
        const bool is_sh = form == Directions::sh;
        EXPECT_NE(manifest->find(is_sh ? "\"form\": \"sh\"" : "\"form\": \"dominant\""), std::string::npos);
        for (const std::optional<std::size_t> group : {std::optional<std::size_t>(), std::optional<std::size_t>(0)}) {
            const std::vector<std::string> names = directional_files(0, group, format);
            EXPECT_EQ(names.size(), is_sh ? 4u : 2u);
            for (const std::string& name : names) {
                EXPECT_NE(manifest->find("\"" + name + "\""), std::string::npos) << name;
                const Result<std::string> file = read_whole_file(folder / ("maps/" + name));
                ASSERT_TRUE(file) << name;
                EXPECT_GT(file->size(), 100u);
            }
        }
    }
}

}  // namespace exitance

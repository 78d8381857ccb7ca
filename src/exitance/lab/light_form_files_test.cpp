#include <gtest/gtest.h>

#include "exitance/io/solution/solution_file.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/solution/layers/light_layers.hpp"
#include "support/sample_solution.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Reads back what is written of a solution with these layers.
Result<Solution> read_back(const std::string& path, Solution solution, const LightLayers& layers) {
    solution.layers = std::make_shared<LayersForm>(layers);
    if (const Result<void> written = write_solution(path, solution); !written) return written.error();
    return load_solution(path);
}

Result<Solution> read_back(const std::string& path, Solution solution, const CellLight& cells) {
    solution.own_form = std::make_shared<CellsForm>(cells);
    solution.delivers_own_form = true;
    if (const Result<void> written = write_solution(path, solution); !written) return written.error();
    return load_solution(path);
}

LightLayers sample_layers() {
    LayerTriangles triangles;
    triangles.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}, triangles.values = {1, 2, 3, 4};
    triangles.corners = {{0, 1, 2}, {1, 3, 2}}, triangles.middles = {{1.5, 2.5, 2}, {3, 3.5, 2.5}};
    LightLayers layers;
    layers.sources = {RegionId(1), RegionId()};
    layers.sheets = {{RegionId(0), 1, Spectrum(0.5), LightLayer(triangles, LightLayer::Form::floats)},
                     {RegionId(1), 0, Spectrum(2), LightLayer(triangles, LightLayer::Form::halves)}};
    for (LightLayers::Sheet& sheet : layers.sheets) sheet.light.make_grid();
    return layers;
}

CellLight sample_cells() {
    CellLight light;
    light.normalised = false;
    for (int i = 0; i < 3; ++i)
        light.cells.push_back({{0.1 * i, 0.2, 0.3}, {0, 0, 1}, 0.5 + i, Spectrum(i), {Spectrum(1), {}, {}}});
    light.triangles = {{0, 1, 2}};
    light.kernel = {{{1, 2, 3}, {4, 5, 6}, 0.7, Spectrum(8)}, {{1, 1, 1}, {2, 2, 2}, 0.1, Spectrum(9)}};
    light.kernel_edges = {{0, 1}};
    return light;
}

void expect_same(const LightLayers& read, const LightLayers& written) {
    EXPECT_EQ(read.sources, written.sources);
    ASSERT_EQ(read.sheets.size(), written.sheets.size());
    for (std::size_t i = 0; i < written.sheets.size(); ++i) {
        const LightLayers::Sheet &a = read.sheets[i], &b = written.sheets[i];
        EXPECT_EQ(a.region, b.region);
        EXPECT_EQ(a.source, b.source);
        EXPECT_EQ(a.colour, b.colour);
        EXPECT_EQ(a.light.at({0.3, 0.4}), b.light.at({0.3, 0.4}));
        EXPECT_EQ(a.light.memory_bytes(), b.light.memory_bytes());
    }
}

void expect_same(const CellLight& read, const CellLight& written) {
    EXPECT_EQ(read.normalised, written.normalised);
    ASSERT_EQ(read.cells.size(), written.cells.size());
    EXPECT_EQ(read.cells[2].at, written.cells[2].at);
    EXPECT_EQ(read.cells[2].value, written.cells[2].value);
    EXPECT_EQ(read.cells[1].slope[0], written.cells[1].slope[0]);
    EXPECT_EQ(read.triangles, written.triangles);
    EXPECT_EQ(read.kernel[1].y, written.kernel[1].y);
    EXPECT_EQ(read.kernel_edges, written.kernel_edges);
}

}  // namespace

TEST(LightFormFiles, HoldLayersAndRefuseThoseThatMakeNoSense) {
    const TemporaryFolder folder;
    const Result<Solution> back = read_back(folder / "s.h5", sample_solution(), sample_layers());
    ASSERT_TRUE(back) << back.error().message;
    expect_same(layers_of(*back), sample_layers());
    LightLayers lost_source = sample_layers(), lost_region = sample_layers();
    lost_source.sheets[0].source = 2;
    EXPECT_FALSE(read_back(folder / "bad.h5", sample_solution(), lost_source));
    lost_region.sheets[1].region = RegionId(100'000);
    EXPECT_FALSE(read_back(folder / "bad.h5", sample_solution(), lost_region));
}

TEST(LightFormFiles, HoldGrownCellsAndRefuseThoseThatMakeNoSense) {
    const TemporaryFolder folder;
    const Result<Solution> back = read_back(folder / "s.h5", sample_solution(), sample_cells());
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(back->delivers_own_form);
    expect_same(cells_of(*back), sample_cells());
    CellLight lost_unit = sample_cells(), flat = sample_cells();
    lost_unit.triangles = {{0, 1, 3}};
    EXPECT_FALSE(read_back(folder / "lost.h5", sample_solution(), lost_unit));
    flat.triangles.clear(), flat.cells[0].width = 0;
    EXPECT_FALSE(read_back(folder / "flat.h5", sample_solution(), flat));
}

TEST(LightForms, AreTheSameAfterACheckpoint) {
    const LayersForm layers(sample_layers());
    const CellsForm cells(sample_cells());
    const LightFormPointer layers_back = unpack_light_form(layers.kind(), layers.packed());
    const LightFormPointer cells_back = unpack_light_form(cells.kind(), cells.packed());
    expect_same(dynamic_cast<const LayersForm&>(*layers_back).layers(), sample_layers());
    expect_same(dynamic_cast<const CellsForm&>(*cells_back).light(), sample_cells());
    EXPECT_EQ(unpack_light_form("", ""), nullptr);
}

}  // namespace exitance

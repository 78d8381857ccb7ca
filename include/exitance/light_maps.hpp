#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "exitance/solution.hpp"

namespace exitance::api {

/// Options of light maps.
struct BakeOptions {
    double density = 0;  ///< Texels per metre; 0: chosen for the scene.
    int padding = 4;     ///< Texels around every chart, at least 1.
    /// Texture coordinates to bake into: "own" (those for light maps in the scene's file), a name such as "TEXCOORD_1"
    /// or "vt", or "unwrap" (coordinates are made). Empty: charts of flat parts, see Chart.
    std::string uv = {};
    int width = 0, height = 0;  ///< Texels of every map in texture coordinates; 0: chosen by `density`.
    /// Show the flat faces, instead of following the normals of the scene's file where it has them.
    bool faceted = false;
};

/// One image of irradiance that covers surfaces. Rows from top to bottom.
struct LightMap {
    int width = 0, height = 0;                         ///< Texels.
    std::vector<std::array<float, bands>> irradiance;  ///< W/m^2, row by row; 0 in unused texels.
    std::vector<float> coverage;                       ///< Share of every texel that is on its surface.
};

/// Rectangle of a light map that shows one flat part of the scene.
struct Chart {
    std::size_t map = 0;                      ///< Index of the map.
    int x = 0, y = 0, width = 0, height = 0;  ///< Texels.
    Vec3 origin;                              ///< Centre of the texel (x, y), metres.
    Vec3 right;                               ///< From a texel to its right neighbour, metres.
    Vec3 down;                                ///< From a texel to its lower neighbour, metres.
    std::vector<std::size_t> faces;           ///< Indices of the scene's faces.
};

struct LightMapsData;

/// Irradiance as images that cover all surfaces. Copies share their data.
class LightMaps {
  public:
    /// Texels per metre; with texture coordinates, the mean over the maps.
    double density() const;
    /// Number of maps.
    std::size_t size() const;
    /// Map `index`, below size().
    LightMap map(std::size_t index) const;
    /// The charts; empty if the maps are in texture coordinates.
    std::vector<Chart> charts() const;
    /// Sentences about texture coordinates that overlap, leave the map or are mirrored, by object.
    std::vector<std::string> warnings() const;
    /// Writes lightmap_N.exr and .png, lightmaps.json, and scene.glb unless the coordinates are those of the scene's
    /// file, into a folder. Each file appears whole or not at all. Error: cannot_write.
    Result<void> save(const std::string& folder) const;

    /// For the library.
    explicit LightMaps(std::shared_ptr<const LightMapsData> data) : data_(std::move(data)) {}

  private:
    std::shared_ptr<const LightMapsData> data_;
};

/// Bakes light maps: every texel holds the mean irradiance over the part of it that is on its surface and not covered.
/// About 5 us per texel in a room with few lamps. Same bits on any number of threads.
/// Errors: usage for a density, padding or size out of range, and for texture coordinates that the scene's file does
/// not have; bad_input if some faces have none; limit after a stop.
Result<LightMaps> bake(const Solution& solution, const BakeOptions& options = {}, const Control& control = {});

}  // namespace exitance::api

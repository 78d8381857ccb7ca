#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

class Hdf5Reader;

enum class FactorFormat {
    csv,         ///< A matrix.
    vf,          ///< View3D's text.
    mtx,         ///< Matrix Market's coordinates.
    hdf5,        ///< Compressed rows.
    energyplus,  ///< Objects ZoneProperty:UserViewFactors:BySurfaceName.
    openfoam,    ///< Files F and globalFaceFaces in a folder.
    pairs,       ///< CSV with a line `from_id,to_id,F` per entry.
};

/// Properties of a format that options and messages depend on.
struct FactorFormatTraits {
    FactorFormat format;
    std::string_view name;    ///< Name in options.
    std::string_view ending;  ///< Ending of files that selects the format; empty: none does.
    bool takes_sky;           ///< True if columns for the sky and for backs can be added.
    bool is_folder = false;   ///< True if the output is a folder of files.
};

inline constexpr std::array<FactorFormatTraits, 7> factor_formats{{
    {FactorFormat::csv, "csv", ".csv", true},
    {FactorFormat::vf, "vf", ".vf", false},
    {FactorFormat::mtx, "mtx", ".mtx", true},
    {FactorFormat::hdf5, "h5", ".h5", false},  // always has the sky
    {FactorFormat::energyplus, "energyplus", ".idf", false},
    {FactorFormat::openfoam, "openfoam", "", false, true},
    {FactorFormat::pairs, "pairs", "", true},
}};

const FactorFormatTraits& traits_of(FactorFormat format);
/// Endings of the formats' files, for messages: ".csv, .vf, ...".
std::string endings_of_factor_files();

/// Returns the format that a path's ending selects; CSV for unknown endings.
FactorFormat factor_format_of(const std::string& path);

struct FactorFileOptions {
    std::optional<FactorFormat> format = {};     ///< Format of the file; empty: given by the path's ending.
    bool with_sky = false;                       ///< Adds the columns `sky` and `back`: csv, mtx and pairs.
    std::string zone = "zone";                   ///< Name of the zone or enclosure in EnergyPlus.
    Point origin = {};                           ///< Subtracted from the coordinates of the scene's file; hdf5 only.
    std::vector<std::int32_t> row_of_face = {};  ///< Row of every face of the scene, -1 for none; hdf5 only.
    /// Gray exchange factors, n x n, row by row; hdf5 only. Empty: none.
    std::vector<double> script_f = {}, gebhart = {};
};

/// Writes view factors. Unfinished rows are omitted from CSV and empty in the other formats. Each file appears whole or
/// not at all. `path` is a folder for openfoam.
///
/// csv  a header `surface,area,row_sum,F_1,...,F_n`, then one row per face, numbered from 1 in the order of the scene
///      file. With 17 digits, reading restores the same doubles.
/// mtx  Matrix Market `coordinate real general`: areas as comments, then one line `i j F_ij` (17 digits) per entry
/// above 0
///
/// Errors: ErrorCode::limit if a stop is requested,
/// ErrorCode::cannot_write.
Result<void> write_view_factors(const std::string& path, const SparseFactors& table, const StopRequest& stop,
                                const FactorFileOptions& options = {});

/// Reads a `.h5` file of write_view_factors().
Result<SparseFactors> read_view_factors(const std::string& path);
/// Reads an open file; `path` is for messages.
Result<SparseFactors> read_view_factors(Hdf5Reader& file, const std::string& path);

/// Formats a table as View3D's text output: a header of 30 characters, areas (%g), rows (%.6f: error up to 5e-7),
/// emittances (%.3f).
std::string view_factors_vf(const SparseFactors& table);

}  // namespace exitance

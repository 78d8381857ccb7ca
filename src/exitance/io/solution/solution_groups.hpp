#pragma once

#include <string>
#include <string_view>

#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

// Parts of a solution file. The readers check every count and index; their results are safe to use unless
// reader.failed() is true afterwards.

/// A scene including its regions, stored so that it is restored bit for bit.
class StoredScene {
  public:
    static void write(Hdf5Writer& file, const std::string& group, const Scene& scene);
    static Scene read(Hdf5Reader& file, const std::string& group);

    /// Versions in memory, for another process of the same program. As in files, the facets of the sky are not stored.
    static std::string bytes_of(const Scene& scene);
    static Result<Scene> from_bytes(std::string_view bytes);

  private:
    template <class Archive>
    static void archive_all(Archive& archive, Scene& scene);
};

/// Directional emission of materials; nothing is stored if all emit diffusely.
void write_emission(Hdf5Writer& file, const std::string& group, const Field<MaterialId, Material>& materials,
                    const Field<ProfileId, EmissionProfile>& profiles);
Field<ProfileId, EmissionProfile> read_profiles(Hdf5Reader& file, const std::string& group);
/// Returns one entry per material.
std::vector<DirectedEmission> read_emission(Hdf5Reader& file, const std::string& group, std::size_t material_count,
                                            std::size_t profile_count);

/// Luminaires with their types; nothing is stored if there are none.
void write_luminaires(Hdf5Writer& file, const std::string& group, const std::vector<LuminaireType>& types,
                      const std::vector<InstalledLuminaire>& luminaires);
std::vector<LuminaireType> read_luminaire_types(Hdf5Reader& file, const std::string& group);
std::vector<InstalledLuminaire> read_luminaires(Hdf5Reader& file, const std::string& group, std::size_t type_count,
                                                std::size_t group_count);

/// A tree that is in the file.
struct WrittenTree {
    std::string group;
    const ElementTree& tree;
};

/// A tree as the patches of its roots and the split of every element, from which all patches are restored bit for bit,
/// and the values at the corners of the leaves, in order. Roots whose corners are on the border of their region are
/// stored by the numbers of these corners. If the roots are those of another tree, the file holds them once. `regions`:
/// those of the scene that the tree covers.
void write_function(Hdf5Writer& file, const std::string& group, const ElementFunction& function,
                    const Field<RegionId, Region>& regions, const std::optional<WrittenTree>& other = {});
ElementFunction read_function(Hdf5Reader& file, const std::string& group, const Field<RegionId, Region>& regions);

/// Links of a hierarchy, with their elements as a function.
void write_links(Hdf5Writer& file, const std::string& group, const KeptLinks& links,
                 const Field<RegionId, Region>& regions);
KeptLinks read_links(Hdf5Reader& file, const std::string& group, const Field<RegionId, Region>& regions);

/// A discontinuity mesh, with its curves.
void write_discontinuity(Hdf5Writer& file, const std::string& group, const SixNodeMesh& mesh);
SixNodeMesh read_discontinuity(Hdf5Reader& file, const std::string& group, std::size_t region_count);

/// Direct light as one mesh per source. The reader checks every count and index: unless `file.failed()`, the layers
/// that it adds to the solution are safe to use. Nothing is written for a solution without layers.
void write_layers(Hdf5Writer& file, const std::string& group, const Solution& solution);
void read_layers(Hdf5Reader& file, const std::string& group, Solution& solution);

/// A group of a solution's file for a LightForm, which the library that defines the form adds.
struct LightFormGroup {
    const char* name;  ///< Name of the group, below "exitance".
    /// Writes the group if the solution has such a form.
    void (*write)(Hdf5Writer& file, const std::string& group, const Solution& solution);
    /// Reads the group, which must exist, into a solution whose scene has been read.
    void (*read)(Hdf5Reader& file, const std::string& group, Solution& solution);
};

/// Adds a group to all files that are written or read from now on. Not while other threads write or read.
void add_light_form_group(const LightFormGroup& group);
std::span<const LightFormGroup> light_form_groups();

/// Light by groups, for the command `mix`.
void write_light_groups(Hdf5Writer& file, const std::string& group, const LightGroups& groups);
LightGroups read_light_groups(Hdf5Reader& file, const std::string& group, const Solution& solution);

/// Statistics, which may differ from run to run. `own`: the unit of the scene's light.
void write_statistics(Hdf5Writer& file, const std::string& group, const SolveStatistics& statistics,
                      const LightUnit& own);
/// Converts the energy of files that store the sum of the bands to the mean, which is exact for scenes in watts, and
/// for scenes in lumens whose light has no colour.
SolveStatistics read_statistics(Hdf5Reader& file, const std::string& group);

/// The group /VTKHDF, which ParaView reads: the leaves of the interpolant as polygons with separate points, since light
/// may be discontinuous between leaves; or the quadratic or cubic triangles of a discontinuity mesh.
void write_vtkhdf(Hdf5Writer& file, const Solution& solution);

}  // namespace exitance

#pragma once

#include <string>
#include <string_view>

#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

// The parts of a solution's file. The readers check every count and index; what they return is safe to use unless
// reader.failed() afterwards.

/// A scene as it is in memory, regions and all, so that it comes back bit for bit.
class StoredScene {
  public:
    static void write(Hdf5Writer& file, const std::string& group, const Scene& scene);
    static Scene read(Hdf5Reader& file, const std::string& group);

    /// The same in memory, for another process of the same program; without facets of the sky, which no file has.
    static std::string bytes_of(const Scene& scene);
    static Result<Scene> from_bytes(std::string_view bytes);

  private:
    template <class Archive>
    static void archive_all(Archive& archive, Scene& scene);
};

/// How materials emit that do not do so diffusely; nothing where all do.
void write_emission(Hdf5Writer& file, const std::string& group, const Field<MaterialId, Material>& materials,
                    const Field<ProfileId, EmissionProfile>& profiles);
Field<ProfileId, EmissionProfile> read_profiles(Hdf5Reader& file, const std::string& group);
/// One for every material.
std::vector<DirectedEmission> read_emission(Hdf5Reader& file, const std::string& group, std::size_t material_count,
                                            std::size_t profile_count);

/// A tree as its roots' patches and how every element was cut, which gives all patches back bit for bit; values in the
/// order of the leaves and their patches' corners.
void write_function(Hdf5Writer& file, const std::string& group, const ElementFunction& function);
ElementFunction read_function(Hdf5Reader& file, const std::string& group, std::size_t region_count);

/// The links of a hierarchy, with their elements as a function.
void write_links(Hdf5Writer& file, const std::string& group, const KeptLinks& links);
KeptLinks read_links(Hdf5Reader& file, const std::string& group, std::size_t region_count);

/// A discontinuity mesh, with its curves.
void write_discontinuity(Hdf5Writer& file, const std::string& group, const SixNodeMesh& mesh);
SixNodeMesh read_discontinuity(Hdf5Reader& file, const std::string& group, std::size_t region_count);

/// A group of a solution's file for a LightForm, which the library that defines the form adds.
struct LightFormGroup {
    const char* name;  ///< Of the group, below "exitance".
    /// Writes the group if the solution has such a form.
    void (*write)(Hdf5Writer& file, const std::string& group, const Solution& solution);
    /// Reads the group, which is there, into the solution, whose scene is read.
    void (*read)(Hdf5Reader& file, const std::string& group, Solution& solution);
};

/// Adds a group to all files that are written or read from now on. Not while other threads write or read.
void add_light_form_group(const LightFormGroup& group);
std::span<const LightFormGroup> light_form_groups();

/// Light by groups, for `mix`.
void write_light_groups(Hdf5Writer& file, const std::string& group, const LightGroups& groups);
LightGroups read_light_groups(Hdf5Reader& file, const std::string& group, const Solution& solution);

/// Everything that may differ from run to run. `own`: the unit of the scene's light.
void write_statistics(Hdf5Writer& file, const std::string& group, const SolveStatistics& statistics,
                      const LightUnit& own);
/// The energy of an older file, which is the sum of the bands, is divided
/// by their number: exactly that of a scene in watts, and of one in lumens whose light has no colour.
SolveStatistics read_statistics(Hdf5Reader& file, const std::string& group);

/// The group /VTKHDF that ParaView opens: the leaves of the interpolant as polygons, each with points of its own,
/// since light may jump from one to the next; or the quadratic or cubic triangles of a discontinuity mesh.
void write_vtkhdf(Hdf5Writer& file, const Solution& solution);

}  // namespace exitance

#include <array>
#include <cstdlib>
#include <cstring>

#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/photometry/luminaire_body.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "exitance/io/scenes/obj/mtl.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "fuzz/solution_target.hpp"
#include "fuzz/target.hpp"

namespace exitance::fuzz {
namespace {

void read_obj_bytes(const std::string& bytes) {
    static const std::string library = file_with(corpus_folder("mtl").at(0), "m.mtl");
    (void)load_scene(file_with(bytes, "s.obj"));
}

void read_mtl_bytes(const std::string& bytes) {
    std::vector<Material> materials;
    std::vector<Finding> findings;
    MtlExtras extras;
    parse_mtl(bytes, "m.mtl", materials, findings, extras);
}

void read_glb_bytes(const std::string& bytes) {
    (void)load_scene(file_with(bytes, "s.glb"));
}
/// Corrects the lengths of the container and its two chunks.
void mend_glb(std::string& bytes) {
    constexpr std::size_t header = 20;
    if (bytes.size() < header + 8) return;
    const auto put = [&](std::size_t at, std::size_t value) {
        const auto number = static_cast<std::uint32_t>(value);
        std::memcpy(bytes.data() + at, &number, 4);
    };
    std::size_t binary = bytes.find(std::string("BIN\0", 4), header);
    if (binary == bytes.npos || binary < header + 4) return;
    binary -= 4;
    bytes.insert(binary, (4 - (binary - header) % 4) % 4, ' ');
    binary += (4 - (binary - header) % 4) % 4;
    put(8, bytes.size()), put(12, binary - header), put(binary, bytes.size() - binary - 8);
}

void read_gltf_bytes(const std::string& bytes) {
    static constexpr std::array<float, 9> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const std::string buffer =
        file_with(std::string(reinterpret_cast<const char*>(triangle.data()), sizeof triangle), "data.bin");
    (void)load_scene(file_with(bytes, "s.gltf"));
}

void read_rad_bytes(const std::string& bytes) {
    static const std::string part = file_with(
        "void light l 0 0 3 1 1 1\nl polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n!xform -t 0 0 1 leaf.rad\n", "part.rad");
    static const std::string leaf = file_with("l ring r 0 0 8 0 0 0 0 0 1 0 .5\n", "leaf.rad");
    (void)load_scene(file_with(bytes, "s.rad"));
}

void read_honeybee_bytes(const std::string& bytes) {
    (void)load_scene(file_with(bytes, "s.hbjson"));
}
void read_ply_bytes(const std::string& bytes) {
    (void)load_scene(file_with(bytes, "s.ply"));
}

void read_csv_bytes(const std::string& bytes) {
    (void)load_probe_points(file_with(bytes, "p.csv"));
}

/// Checks that the luminaire of an accepted file can be built, too.
void build(const Result<Photometry>& photometry) {
    if (photometry && !make_luminaire_body(*photometry).profile.is_sane()) std::abort();
}
void read_ies_bytes(const std::string& bytes) {
    build(read_ies(bytes, "f.ies"));
}
void read_ldt_bytes(const std::string& bytes) {
    build(read_eulumdat(bytes, "f.ldt"));
}

void read_pts_bytes(const std::string& bytes) {
    (void)load_probe_points(file_with(bytes, "p.pts"));
}

void read_reference_bytes(const std::string& bytes) {
    (void)load_probe_reference(file_with(bytes, "r.csv"));
}

}  // namespace

std::span<const Target> targets() {
    static constexpr std::array all = {
        Target{"obj", read_obj_bytes},
        Target{"mtl", read_mtl_bytes},
        Target{"glb", read_glb_bytes, mend_glb},
        Target{"gltf", read_gltf_bytes},
        Target{"rad", read_rad_bytes},
        Target{"ply", read_ply_bytes},
        Target{"hbjson", read_honeybee_bytes},
        Target{"csv", read_csv_bytes},
        Target{"pts", read_pts_bytes},
        Target{"reference", read_reference_bytes},
        Target{"ies", read_ies_bytes},
        Target{"ldt", read_ldt_bytes},
        Target{"solution", read_solution_bytes, mend_solution, solution_corpus, rehearse_solution_bytes,
               read_rehearsed_solution},
        Target{"values", read_solution_with_values, nullptr, value_corpus, rehearse_solution_with_values,
               read_rehearsed_solution},
    };
    return all;
}

}  // namespace exitance::fuzz

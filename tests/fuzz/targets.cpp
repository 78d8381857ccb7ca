#include <array>
#include <cstring>

#include "exitance/io/mtl.hpp"
#include "exitance/io/probe_file.hpp"
#include "exitance/io/scene_file.hpp"
#include "fuzz/solution_target.hpp"
#include "fuzz/target.hpp"

namespace exitance::fuzz {
namespace {

std::vector<std::string> obj_corpus() {
    return corpus_folder("obj");
}
void read_obj_bytes(const std::string& bytes) {
    static const std::string library = corpus_folder("mtl").at(0);
    file_with(library, "m.mtl");
    (void)load_scene(file_with(bytes, "s.obj"));
}

std::vector<std::string> mtl_corpus() {
    return corpus_folder("mtl");
}
void read_mtl_bytes(const std::string& bytes) {
    std::vector<Material> materials;
    std::vector<Finding> findings;
    parse_mtl(bytes, "m.mtl", materials, findings);
}

std::vector<std::string> glb_corpus() {
    return corpus_folder("glb");
}
void read_glb_bytes(const std::string& bytes) {
    (void)load_scene(file_with(bytes, "s.glb"));
}
/// The lengths of the container and of its two chunks.
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

std::vector<std::string> gltf_corpus() {
    return corpus_folder("gltf");
}
void read_gltf_bytes(const std::string& bytes) {
    (void)load_scene(file_with(bytes, "s.gltf"));
}

std::vector<std::string> rad_corpus() {
    return corpus_folder("rad");
}
void read_rad_bytes(const std::string& bytes) {
    file_with("void light l 0 0 3 1 1 1\nl polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n!xform -t 0 0 1 leaf.rad\n", "part.rad");
    file_with("l ring r 0 0 8 0 0 0 0 0 1 0 .5\n", "leaf.rad");
    (void)load_scene(file_with(bytes, "s.rad"));
}

std::vector<std::string> csv_corpus() {
    return corpus_folder("csv");
}
void read_csv_bytes(const std::string& bytes) {
    (void)load_probe_points(file_with(bytes, "p.csv"));
}

std::vector<std::string> pts_corpus() {
    return corpus_folder("pts");
}
void read_pts_bytes(const std::string& bytes) {
    (void)load_probe_points(file_with(bytes, "p.pts"));
}

std::vector<std::string> reference_corpus() {
    return corpus_folder("reference");
}
void read_reference_bytes(const std::string& bytes) {
    (void)load_probe_reference(file_with(bytes, "r.csv"));
}

}  // namespace

std::span<const Target> targets() {
    static constexpr std::array all = {
        Target{"obj", obj_corpus, read_obj_bytes},
        Target{"mtl", mtl_corpus, read_mtl_bytes},
        Target{"glb", glb_corpus, read_glb_bytes, mend_glb},
        Target{"gltf", gltf_corpus, read_gltf_bytes},
        Target{"rad", rad_corpus, read_rad_bytes},
        Target{"csv", csv_corpus, read_csv_bytes},
        Target{"pts", pts_corpus, read_pts_bytes},
        Target{"reference", reference_corpus, read_reference_bytes},
        Target{"solution", solution_corpus, read_solution_bytes, mend_solution},
        Target{"values", value_corpus, read_solution_with_values},
    };
    return all;
}

}  // namespace exitance::fuzz

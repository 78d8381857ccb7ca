#include <array>

#include "exitance/io/mtl.hpp"
#include "exitance/io/scene_file.hpp"
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

}  // namespace

std::span<const Target> targets() {
    static constexpr std::array all = {
        Target{"obj", obj_corpus, read_obj_bytes},
        Target{"mtl", mtl_corpus, read_mtl_bytes},
    };
    return all;
}

}  // namespace exitance::fuzz

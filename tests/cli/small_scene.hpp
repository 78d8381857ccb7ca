#pragma once

#include <string>

#include "run_program.hpp"

namespace exitance::test {

/// Writes a closed grey room of 4 x 3 x 2.5 m with a square lamp that hangs below its ceiling: 7 faces. Returns the
/// path of the OBJ file.
inline std::string write_small_room(const TemporaryFolder& folder, const std::string& name = "room") {
    write_text(folder / (name + ".mtl"),
               "newmtl grey\nKd 0.5 0.4 0.3\nKe 0 0 0\n"
               "newmtl lamp\nKd 0 0 0\nKe 10 10 10\n");
    write_text(folder / (name + ".obj"), "mtllib " + name +
                                             ".mtl\n"
                                             "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\n"
                                             "v 0 0 2.5\nv 4 0 2.5\nv 4 3 2.5\nv 0 3 2.5\n"
                                             "v 1.5 1 2.3\nv 2.5 1 2.3\nv 2.5 2 2.3\nv 1.5 2 2.3\n"
                                             "usemtl grey\ng floor\nf 1 2 3 4\ng ceiling\nf 8 7 6 5\n"
                                             "g walls\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
                                             "usemtl lamp\ng lamp\nf 12 11 10 9\n");
    return folder / (name + ".obj");
}

/// Writes a scene with an error in line 9: a face whose corner does not exist.
inline std::string write_broken_scene(const TemporaryFolder& folder) {
    write_text(folder / "broken.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    write_text(folder / "broken.obj",
               "mtllib broken.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\nusemtl grey\nf 1 2 3 4\nf 1 2 7\n");
    return folder / "broken.obj";
}

}  // namespace exitance::test

#pragma once

#include <cstdio>
#include <sstream>
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

/// The small room in another unit, with Y up if asked: `per_metre` units are a metre.
inline std::string write_small_room_in(const TemporaryFolder& folder, double per_metre, bool y_up,
                                       const std::string& name) {
    std::istringstream lines(read_text(write_small_room(folder, name)));
    std::ostringstream out;
    for (std::string line; std::getline(lines, line);) {
        double x = 0, y = 0, z = 0;
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) != 3)
            out << line << '\n';
        else if (y_up)
            out << "v " << per_metre * x << ' ' << per_metre * z << ' ' << -per_metre * y << '\n';
        else
            out << "v " << per_metre * x << ' ' << per_metre * y << ' ' << per_metre * z << '\n';
    }
    write_text(folder / (name + ".obj"), out.str());
    return folder / (name + ".obj");
}

/// Writes a room without a ceiling, half of which is covered by a pane. Returns the
/// path of the OBJ file.
inline std::string write_court(const TemporaryFolder& folder) {
    write_text(folder / "court.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nd 0.1\n");
    write_text(folder / "court.obj",
               "mtllib court.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2.5\nv 4 0 2.5\nv 4 3 2.5\nv 0 3 2.5\n"
               "v 2 0 2.5\nv 2 3 2.5\nusemtl grey\nf 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
               "usemtl glass\nf 5 9 10 8\n");
    return folder / "court.obj";
}

/// Writes a scene with an error in line 9: a face whose corner does not exist.
inline std::string write_broken_scene(const TemporaryFolder& folder) {
    write_text(folder / "broken.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    write_text(folder / "broken.obj",
               "mtllib broken.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\nusemtl grey\nf 1 2 3 4\nf 1 2 7\n");
    return folder / "broken.obj";
}

}  // namespace exitance::test

#pragma once

#include <string>

namespace exitance::test {

/// Paths that tests use. Only places.cpp depends on them, so that in another copy of the repository all other files
/// compile identically.
std::string source_folder();  ///< The repository.
std::string data_folder();    ///< Scenes and references, see tests/data/README.md.
std::string program();        ///< The built program.
std::string mpirun();         ///< Program that starts several processes; empty if the build has no MPI.

}  // namespace exitance::test

#pragma once

#include <string>

namespace exitance::test {

/// Where things are that tests read and run. One file is told by the build, so that a copy of the repository elsewhere
/// compiles all others alike.
std::string source_folder();  ///< Of the repository.
std::string shared_folder();  ///< Of scenes and references that are not part of it; it may not be there.
std::string program();        ///< The program that was built.
std::string mpirun();         ///< Starts several processes; empty where the build has no MPI.

}  // namespace exitance::test

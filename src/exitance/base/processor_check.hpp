#pragma once

namespace exitance {

/// Instruction sets beyond those of every x86-64 processor, as bits.
enum InstructionSets : unsigned { sse42 = 1, avx = 2, avx2 = 4, fma = 8, bmi2 = 16, avx512 = 32 };

/// Instruction sets that all functions of this build may use (EXITANCE_ARCH of CMake).
extern const unsigned sets_of_build;

/// Instruction sets of the processor that runs the program; avx512 is set if the parts F, DQ, VL and BW are all
/// available.
unsigned sets_of_processor();

/// Returns the name of the first set that is needed but not available, or null if there is none.
const char* missing_set(unsigned needed, unsigned available);

}  // namespace exitance

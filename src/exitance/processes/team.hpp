#pragma once

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdint>
#include <map>
#include <string>

#include "exitance/processes/distributed.hpp"

// State and calls of MPI that distributed.cpp and shared_pages.cpp have in common. No other file includes this one.

namespace exitance {

/// State of the communication with the other processes.
struct Team {
    std::size_t size = 1, own = 0;
    bool joined = false;
    const StopRequest* asked = nullptr;
    StopRequest* agreed = nullptr;
    std::uint64_t meetings = 0;
    MPI_Comm node = MPI_COMM_NULL;  ///< Processes of this node.
    int node_size = 1;
    std::size_t shared_bytes = 0;
    int common_file = -1;  ///< File of the memory that is open in common; -1: none.
    std::map<std::string, Traffic> traffic;
    ExchangeTime time;
    std::map<std::string, DealtTime> dealt;
    /// Values at the end of the last shared loop, seconds: distributed and total processor time.
    double dealt_before = 0, taken_before = 0;
};
extern Team team;

/// Ends all processes with a message. Failing MPI calls end the job by default; this is for errors that exitance finds.
[[noreturn]] void end_job(const char* why);

/// Waits for a request without occupying a processor, unlike MPI_Wait, which polls continuously. Polls 200 times in
/// succession at first, then at intervals of a twentieth of the time waited so far, so that the added delay is small.
void wait_for(MPI_Request& request);

/// Combines the values of all processes of a group by an operation. Collective in that group.
template <class T>
void reduce(const T* own, T* all, int count, MPI_Datatype type, MPI_Op operation, MPI_Comm group) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(own, all, count, type, operation, group, &request);
    wait_for(request);
}

}  // namespace exitance

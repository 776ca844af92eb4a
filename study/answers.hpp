// SPDX-License-Identifier: MIT
#pragma once

#include "study/request.hpp"

namespace sphstab::study {

/// The answers of the commands. Each reads the keys it needs and throws InvalidInput for what is missing or wrong.

/// `dt`: critical time step of the infinite lattice with all that the interface lists under it. With wave_vector (or
/// mode and box) also the limit of that mode, with box alone that of the paper's M×L modes.
Json time_step_answer(const Case& input, const Request& request);

/// `matrix`: the amplification matrix at one mode.
Json matrix_answer(const Case& input, const Request& request);

/// `bisect`: the critical step found by running, beside the theory of the same patch, plate or scene.
Json bisection_answer(const Case& input, const Request& request);

/// `spectrum`: the critical step of a whole plate or scene with its bracket and, with lowest_modes, its lowest
/// frequencies and modes; their shapes into request.folder.
Json spectrum_answer(const Case& input, const Request& request);

/// `run`: a scene from rest, for `duration`, at `time_step` or `step_fraction` of its critical step. States (HDF5 with
/// its XDMF companion), pictures, probes and a summary into request.folder. `unstable` if it has grown beyond bounds.
Json run_answer(const Case& input, const Request& request);

/// `kernel` (batch only): W, dW, d2W and the normalisation at a distance.
Json kernel_answer(const Case& input, const Request& request);

/// `sums` (batch only): Gray's lattice sums at a wave vector.
Json sums_answer(const Case& input, const Request& request);

}  // namespace sphstab::study

// SPDX-License-Identifier: GPL-3.0-or-later
// Room for the work of BLAS, found before it is needed.
#pragma once

namespace hilo {

/// OpenBLAS takes a buffer of 128 MB of address space at its first use, keeps it, and where the system refuses asks again for ever.  This
/// takes it before; Error (exit 4) where there is no room.  Cheap when called again.
void make_room_for_blas();

/// Error (exit 4) where a limit (`ulimit -v`) or the system leaves no `megabytes` of address space; `what` needs them.
void require_address_space(int megabytes, const char* what);

}  // namespace hilo

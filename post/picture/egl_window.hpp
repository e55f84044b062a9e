// SPDX-License-Identifier: GPL-3.0-or-later
// An off-screen render window that needs no display: a Mesa EGL surfaceless context (docs/notes: Debian's VTK is built for X only).
#pragma once
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

namespace hilo {

/// A window of `width` x `height` pixels that draws into memory.  Error (exit 4) where EGL or the software renderer is not installed.
/// Keep one alive at a time.
vtkSmartPointer<vtkRenderWindow> egl_window(int width, int height);

}  // namespace hilo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/confined.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace hilo {
namespace {

#if defined(__x86_64__)
constexpr unsigned machine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned machine = AUDIT_ARCH_AARCH64;
#else
constexpr unsigned machine = 0;
#endif

/// Calls that are refused whatever their arguments.
constexpr std::array refused {
  SYS_execve, SYS_execveat, SYS_socket, SYS_socketpair, SYS_connect, SYS_bind, SYS_sendto, SYS_sendmsg, SYS_unlinkat, SYS_renameat,
      SYS_renameat2, SYS_mkdirat, SYS_mknodat, SYS_linkat, SYS_symlinkat, SYS_fchmodat, SYS_fchownat, SYS_fchmod, SYS_fchown, SYS_truncate,
      SYS_ftruncate, SYS_fallocate, SYS_utimensat, SYS_setxattr, SYS_lsetxattr, SYS_fsetxattr, SYS_removexattr, SYS_mount, SYS_umount2,
      SYS_chroot, SYS_ptrace, SYS_kill, SYS_process_vm_writev, SYS_process_vm_readv, SYS_memfd_create, SYS_shmget, SYS_pivot_root,
      SYS_setns, SYS_unshare, SYS_io_setup, SYS_bpf, SYS_keyctl, SYS_add_key,
#if defined(__x86_64__)
      SYS_fork, SYS_vfork, SYS_creat, SYS_unlink, SYS_rename, SYS_mkdir, SYS_rmdir, SYS_mknod, SYS_link, SYS_symlink, SYS_chmod, SYS_chown,
      SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat,
#endif
};
/// Calls whose arguments lie in memory, where a filter cannot look: told to be unknown, and the C library takes the older ones.
constexpr std::array<long, 3> unknown{435 /* clone3 */, 437 /* openat2 */, 425 /* io_uring_setup */};

std::vector<sock_filter> program() {
  std::vector<sock_filter> p;
  const auto load = [&](size_t offset) { p.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(offset))); };
  const auto answer = [&](unsigned what) { p.push_back(BPF_STMT(BPF_RET | BPF_K, what)); };
  const auto argument = [](int i) { return offsetof(seccomp_data, args) + 8 * static_cast<size_t>(i); };  // its lower half
  constexpr unsigned no = SECCOMP_RET_ERRNO | EPERM, none = SECCOMP_RET_ERRNO | ENOSYS, yes = SECCOMP_RET_ALLOW;
  load(offsetof(seccomp_data, arch));
  p.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, machine, 1, 0));
  answer(no);
  load(offsetof(seccomp_data, nr));
#if defined(__x86_64__)
  p.push_back(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, 0x40000000, 0, 1));  // the same calls under numbers of x32
  answer(no);
#endif
  const auto when = [&](long call, unsigned then) {
    p.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 1));
    answer(then);
  };
  for (const long call : refused) when(call, no);
  for (const long call : unknown) when(call, none);
  // `call` passes where its argument i has any of `bits` (wanted) or none of them
  const auto look = [&](long call, int i, unsigned bits, bool wanted) {
    p.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 4));
    load(argument(i));
    p.push_back(
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, static_cast<unsigned char>(wanted ? 0 : 1), static_cast<unsigned char>(wanted ? 1 : 0)));
    answer(yes);
    answer(no);
  };
  constexpr unsigned writing = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
  look(SYS_openat, 2, writing, false);
#if defined(__x86_64__)
  look(SYS_open, 1, writing, false);
#endif
  look(SYS_clone, 0, CLONE_THREAD, true);
  answer(yes);
  return p;
}

bool hold_this_thread() {
  if (!machine) return false;
  auto p = program();
  const sock_fprog all{static_cast<unsigned short>(p.size()), p.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all, 0, 0) == 0;
}

}  // namespace

std::string confined(const std::function<void()>& body) {
  std::exception_ptr thrown;
  bool held = false;
  char* none[] = {nullptr};
  char** const environment = std::exchange(environ, none);  // nobody else looks: this thread waits
  std::thread([&] {
    held = hold_this_thread();
    try {
      body();
    } catch (...) {
      thrown = std::current_exception();
    }
  }).join();
  environ = environment;
  if (thrown) std::rethrow_exception(thrown);
  return held ? "" : "this kernel has no seccomp: the file was looked through, and gmsh not confined";
}

}  // namespace hilo

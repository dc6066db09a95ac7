#pragma once

namespace touchstone {

/// From here on this process can open no file, reach no network and start nothing: every system call besides
/// those for memory, time, its open files and its own end fails with EPERM. Throws
/// std::runtime_error where the kernel does not offer this.
void enterSandbox();

} // namespace touchstone

// libstdc++ reads this variable of glibc where a shared_ptr counts its references, directly, since most of
// our code is compiled for a program. A shared library cannot refer to another one's data in that way, so it
// gets one of its own, which the version script keeps inside. Zero is always right: references are counted by
// atomic operations.
#include <sys/single_threaded.h>

char __libc_single_threaded = 0;

/* A busy machine in one process: once, a thread beside the main one gets no processor for a second after it
   has been woken in poll(). Open MPI's own thread waits there for the event that MPI_Init leaves to it. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <poll.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int poll(struct pollfd *fds, nfds_t count, int timeout) {
  static int late = 0;
  int (*real)(struct pollfd *, nfds_t, int) = (int (*)(struct pollfd *, nfds_t, int))dlsym(RTLD_NEXT, "poll");
  const int result = real(fds, count, timeout);
  if (gettid() != getpid() && !late) {
    late = 1;
    fprintf(stderr, "a thread is late\n");
    for (const double start = seconds();
         seconds() < start + 1;) { /* ready to run, as in the queue of a processor */
    }
  }
  return result;
}

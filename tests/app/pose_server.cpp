// An OpenIGTLink server for the window's tests: a probe that sways, 50 times a second, until it is killed. Prints its
// port.
//   pose_server PORT      0: any that is free

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "devices/igtl/igtl_server.h"

int main(int argc, char** argv) {
  using namespace insonate;
  if (argc != 2) return 2;
  igtl::Server server(igtl::numeric_address("127.0.0.1", std::uint16_t(std::atoi(argv[1]))), "PORT");
  std::printf("%d\n", int(server.address().port()));
  std::fflush(stdout);
  for (int i = 0;; ++i) {
    const Pose pose{glm::dmat3(1.0), {0, -40, 30 * std::sin(0.02 * i)}};
    server.publish(igtl::Server::Stream::pose, igtl::make_transform("Probe", 0, pose));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

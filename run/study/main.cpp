// gcpdda-study STUDY FOLDER [--quick]: one of the studies, its tables into the folder. run/study.sh calls it
// and draws the charts.

#include "study.hpp"

#include "gcpdda/parallel/communicator.hpp"

#include <exception>
#include <iostream>
#include <map>
#include <string>

int main(int argc, char **argv) {
  using namespace gcpdda::study;
  const std::map<std::string, void (*)(const Options &)> studies{
      {"stability", stability}, {"accuracy", accuracy}, {"fidelity", fidelity}, {"flutter", flutter}};
  const gcpdda::MpiScope mpi(argc, argv);
  try {
    const bool quick = argc == 4 && std::string(argv[3]) == "--quick";
    if (argc != (quick ? 4 : 3) || !studies.contains(argv[1])) {
      std::cerr << "usage: gcpdda-study stability|accuracy|fidelity|flutter FOLDER [--quick]\n";
      return 2;
    }
    const Options options{argv[2], quick};
    std::filesystem::create_directories(options.folder);
    studies.at(argv[1])(options);
    return 0;
  } catch (const std::exception &error) {
    std::cerr << "gcpdda-study: " << error.what() << "\n";
    return 1;
  }
}

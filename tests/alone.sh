# Stands in for mpiexec where phr is built without MPI: `alone.sh -n P COMMAND...` runs
# the command.
shift 2
exec "$@"

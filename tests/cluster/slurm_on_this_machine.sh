# Sourced: a whole Slurm cluster of one node, this machine, that belongs to the caller alone. All of its files lie in
# one folder, its ports are free ones; whom it believes is decided by a key that it makes for itself (munge). No service of
# the machine is touched.
#
#   start_slurm FOLDER    starts it; 77, and why in $slurm_why_not, where it cannot be
#   stop_slurm            stops it and every job; call it from a trap
#
# Should the caller be killed, its daemons end with it.
# shellcheck shell=bash disable=SC2034

slurm_folder=
slurm_daemons=() # process ids, in the order in which they start
slurm_why_not=

free_port() {
  local port
  for port in $(shuf -i 20000-30000 -n 50); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || {
      echo "$port"
      return
    }
  done
  return 1
}

# cred_expire: a requeued job rests for so many seconds before it starts again; two minutes if not told.
write_slurm_conf() {
  local me
  me=$(id -un)
  cat >"$slurm_folder/slurm.conf" <<END
ClusterName=one
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$me
SlurmdUser=$me
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$slurm_folder/munge.socket,cred_expire=5
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,sched_min_interval=10000,batch_sched_delay=0
StateSaveLocation=$slurm_folder/state
SlurmdSpoolDir=$slurm_folder/spool
SlurmctldPidFile=$slurm_folder/slurmctld.pid
SlurmdPidFile=$slurm_folder/slurmd.pid
SlurmctldLogFile=$slurm_folder/slurmctld.log
SlurmdLogFile=$slurm_folder/slurmd.log
PlugStackConfig=$slurm_folder/plugstack.conf
ReturnToService=2
KillWait=2
MinJobAge=300
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
  : >"$slurm_folder/plugstack.conf"
}

slurm_cannot() {
  slurm_why_not=$1
  return 77
}

# run_daemon NAME COMMAND...
run_daemon() {
  local name=$1
  shift
  setpriv --pdeathsig KILL "$@" >"$slurm_folder/$name.out" 2>&1 &
  slurm_daemons+=($!)
}

daemons_live() {
  local pid
  for pid in "${slurm_daemons[@]}"; do
    kill -0 "$pid" 2>/dev/null || return 1
  done
}

# eventually COMMAND...: polls for ten seconds, as long as the daemons live
eventually() {
  local end=$((SECONDS + 10))
  until "$@"; do
    daemons_live && ((SECONDS < end)) || return 1
    sleep 0.1
  done
}

munge_answers() { timeout 2 munge --no-input --socket="$slurm_folder/munge.socket" >/dev/null 2>&1; }
node_is_idle() { [ "$(timeout 2 sinfo --noheader --format=%T 2>/dev/null)" = idle ]; }

no_job_left() { [ -z "$(timeout 2 squeue --noheader 2>/dev/null)" ]; }

start_slurm() {
  slurm_folder=$1
  local program
  unset "${!SLURM_@}" "${!SBATCH_@}" # of a job that the caller itself may run in
  PATH=$PATH:/usr/sbin
  for program in munged munge slurmctld slurmd sbatch squeue scontrol scancel sinfo; do
    command -v "$program" >/dev/null || {
      slurm_cannot "$program is not installed (Debian: slurm-wlm)"
      return
    }
  done
  mkdir -p "$slurm_folder/state" "$slurm_folder/spool"
  chmod 700 "$slurm_folder"
  write_slurm_conf
  export SLURM_CONF=$slurm_folder/slurm.conf
  (umask 077 && head -c 128 /dev/urandom >"$slurm_folder/munge.key")
  # --force: the folder is open to nobody else, which is what is wanted here
  run_daemon munged munged --foreground --force --key-file="$slurm_folder/munge.key" \
    --socket="$slurm_folder/munge.socket" --pid-file="$slurm_folder/munged.pid" \
    --seed-file="$slurm_folder/munged.seed" --log-file="$slurm_folder/munged.log" --num-threads=2
  if eventually munge_answers; then
    run_daemon slurmctld slurmctld -D -i
    run_daemon slurmd slurmd -D
    eventually node_is_idle && return
  fi
  slurm_cannot "Slurm does not start here: $(tail -n 2 "$slurm_folder"/*.out "$slurm_folder"/*.log 2>/dev/null)"
}

stop_slurm() {
  [ "${#slurm_daemons[@]}" -gt 0 ] || return 0
  timeout 2 scancel --user="$(id -un)" 2>/dev/null || true
  eventually no_job_left || true
  local tries last pid
  # The node first: it answers for its job steps, which are processes of their own.
  for ((last = ${#slurm_daemons[@]} - 1; last >= 0; --last)); do
    pid=${slurm_daemons[$last]}
    kill -TERM "$pid" 2>/dev/null || true
    for ((tries = 0; tries < 50; ++tries)); do
      kill -0 "$pid" 2>/dev/null || break
      sleep 0.1
    done
    kill -KILL "$pid" 2>/dev/null || true
    wait "$pid" 2>/dev/null || true
  done
  slurm_daemons=()
}

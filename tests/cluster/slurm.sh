# slurm.sh — functions that start and stop a Slurm of one node for a test: root, loopback, own key, no systemd, no
# control groups. Reads $work, a folder that the caller removes.

start_slurm() {
  local program ports
  for program in slurmctld slurmd munged sbatch; do
    command -v $program >/dev/null || { echo "skipped: $program is not here (Debian: slurm-wlm)"; return 77; }
  done
  [ "$(id -u)" = 0 ] || { echo "skipped: Slurm's daemons need root here"; return 77; }
  local d=$work/slurm node
  node=$(hostname -s)
  mkdir -p "$d"/state "$d"/spool
  chmod 755 "$work" "$d"
  head -c 64 /dev/urandom >"$d/munge.key"
  chmod 600 "$d/munge.key"
  ports=$((20000 + $$ % 20000))
  cat >"$d/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=$ports
SlurmdPort=$((ports + 1))
AuthType=auth/munge
AuthInfo=socket=$d/munge.socket,cred_expire=5
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
SlurmctldPidFile=$d/slurmctld.pid
SlurmdPidFile=$d/slurmd.pid
SlurmctldLogFile=$d/slurmctld.log
SlurmdLogFile=$d/slurmd.log
StateSaveLocation=$d/state
SlurmdSpoolDir=$d/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=2
SlurmdParameters=config_overrides
MpiDefault=none
ReturnToService=2
KillWait=1
NodeName=$node NodeAddr=127.0.0.1 CPUs=12 RealMemory=2000
PartitionName=main Nodes=$node Default=YES MaxTime=60
END
  export SLURM_CONF=$d/slurm.conf
  if ! { munged --force --key-file="$d/munge.key" --socket="$d/munge.socket" --pid-file="$d/munge.pid" \
      --log-file="$d/munge.log" --seed-file="$d/munge.seed" && slurmctld && slurmd; } >"$d/start.log" 2>&1; then
    echo "skipped: Slurm does not start here: $(tail -n 1 "$d/start.log")"
    return 77
  fi
  local n
  for n in $(seq 60); do
    [ "$(sinfo -h -o %T 2>/dev/null)" != idle ] || return 0
    sleep 0.5
  done
  echo "skipped: Slurm's node does not come up here: $(tail -n 1 "$d/slurmd.log")"
  return 77
}

stop_slurm() {
  local d=$work/slurm daemon n
  [ ! -e "$d/slurmctld.pid" ] || { timeout 5 scancel --user=root || true; }
  for daemon in slurmd slurmctld munge; do
    [ ! -e "$d/$daemon.pid" ] || kill "$(cat "$d/$daemon.pid")" || true
  done
  for n in $(seq 50); do
    [ -e "$d/slurmd.pid" ] || [ -e "$d/slurmctld.pid" ] || [ -e "$d/munge.pid" ] || break
    sleep 0.1
  done
} 2>/dev/null

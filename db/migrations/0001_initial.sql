-- Documents are kept as text; the columns beside them exist to find them by.
-- Times are microseconds since 1970 UTC.

CREATE TABLE calibration (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'cancelled')),
  created_at INTEGER NOT NULL,
  started_at INTEGER,
  finished_at INTEGER,
  request TEXT NOT NULL,
  request_digest TEXT NOT NULL,
  progress TEXT,
  fit TEXT,
  misfit REAL,
  error TEXT,
  CHECK ((finished_at IS NULL) = (state IN ('queued', 'running')))
) STRICT;

CREATE INDEX calibration_by_state ON calibration (state, id);
CREATE INDEX calibration_by_digest ON calibration (request_digest, state, id);
CREATE INDEX calibration_by_name ON calibration (name, misfit) WHERE fit IS NOT NULL;

-- What is finished stays as it is.
CREATE TRIGGER calibration_final BEFORE UPDATE ON calibration
WHEN old.state IN ('done', 'failed', 'cancelled')
BEGIN
  SELECT RAISE(ABORT, 'a finished calibration does not change');
END;

-- An answer is named by the digest of its question: equal questions share one row.
CREATE TABLE evaluation (
  key TEXT PRIMARY KEY,
  question TEXT NOT NULL,
  answer TEXT NOT NULL,
  seconds REAL NOT NULL,
  engine_version TEXT NOT NULL,
  created_at INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TRIGGER evaluation_final BEFORE UPDATE ON evaluation
BEGIN
  SELECT RAISE(ABORT, 'an evaluation does not change');
END;

-- Which evaluations a calibration used, in the order of work.
CREATE TABLE calibration_evaluation (
  calibration_id INTEGER NOT NULL REFERENCES calibration (id),
  ordinal INTEGER NOT NULL,
  key TEXT NOT NULL REFERENCES evaluation (key),
  PRIMARY KEY (calibration_id, ordinal)
) STRICT, WITHOUT ROWID;

-- What a calibrated model lacks: asked of a finished calibration, answered once.
CREATE TABLE diagnosis (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  calibration_id INTEGER NOT NULL REFERENCES calibration (id),
  state TEXT NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'cancelled')),
  created_at INTEGER NOT NULL,
  finished_at INTEGER,
  request TEXT NOT NULL,
  progress TEXT,
  result TEXT,
  error TEXT,
  CHECK ((finished_at IS NULL) = (state IN ('queued', 'running')))
) STRICT;

CREATE INDEX diagnosis_by_calibration ON diagnosis (calibration_id, id);

CREATE TRIGGER diagnosis_final BEFORE UPDATE ON diagnosis
WHEN old.state IN ('done', 'failed', 'cancelled')
BEGIN
  SELECT RAISE(ABORT, 'a finished diagnosis does not change');
END;

-- Which evaluations it used, in the order of work.
CREATE TABLE diagnosis_evaluation (
  diagnosis_id INTEGER NOT NULL REFERENCES diagnosis (id),
  ordinal INTEGER NOT NULL,
  key TEXT NOT NULL REFERENCES evaluation (key),
  PRIMARY KEY (diagnosis_id, ordinal)
) STRICT, WITHOUT ROWID;

-- Every attempt to answer a question: a row before it begins, so that none is begun twice under one
-- number. The numbers of a key only grow, and what has ended stays as it is: the answer of an attempt
-- that was given up changes nothing.
CREATE TABLE attempt (
  key TEXT NOT NULL,
  n INTEGER NOT NULL CHECK (n >= 0),
  executor TEXT NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('running', 'answered', 'refused', 'crashed',
    'out_of_memory', 'timed_out', 'lost', 'cancelled')),
  started_at INTEGER NOT NULL,
  finished_at INTEGER,
  account TEXT NOT NULL DEFAULT '',
  PRIMARY KEY (key, n),
  CHECK ((finished_at IS NULL) = (state = 'running'))
) STRICT, WITHOUT ROWID;

CREATE INDEX attempt_running ON attempt (state) WHERE state = 'running';

CREATE TRIGGER attempt_final BEFORE UPDATE ON attempt
WHEN old.state <> 'running'
BEGIN
  SELECT RAISE(ABORT, 'an attempt that has ended does not change');
END;

-- How many ended how, kept up to date so that nobody has to count.
CREATE TABLE attempt_total (
  state TEXT PRIMARY KEY,
  attempts INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TRIGGER attempt_counted AFTER UPDATE OF state ON attempt
BEGIN
  INSERT INTO attempt_total VALUES (new.state, 1)
  ON CONFLICT (state) DO UPDATE SET attempts = attempts + 1;
END;

//! Tables of results, written as CSV and as Parquet. All columns have the same length.

use anyhow::{Context, Result, ensure};
use parquet::basic::{Compression, ConvertedType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Values of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Real numbers.
    Reals(Vec<f64>),
    /// Integers.
    Integers(Vec<i64>),
    /// Texts.
    Texts(Vec<String>),
}

impl Column {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Reals(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn cell(&self, row: usize) -> String {
        match self {
            Self::Reals(values) => values[row].to_string(),
            Self::Integers(values) => values[row].to_string(),
            Self::Texts(values) => values[row].clone(),
        }
    }

    fn field(&self, name: &str) -> Result<Type> {
        let (physical, meaning) = match self {
            Self::Reals(_) => (Physical::DOUBLE, ConvertedType::NONE),
            Self::Integers(_) => (Physical::INT64, ConvertedType::NONE),
            Self::Texts(_) => (Physical::BYTE_ARRAY, ConvertedType::UTF8),
        };
        let field = Type::primitive_type_builder(name, physical).with_converted_type(meaning);
        Ok(field.with_repetition(Repetition::REQUIRED).build()?)
    }
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    columns: Vec<(String, Column)>,
    /// Origin of the results, stored in the Parquet file's metadata.
    pub origin: Vec<(String, String)>,
}

impl Frame {
    /// Adds a column. All columns must have the same length.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, column: Column) -> Self {
        self.columns.push((name.into(), column));
        self
    }

    /// Adds a column of real numbers.
    #[must_use]
    pub fn reals(self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        self.with(name, Column::Reals(values.into_iter().collect()))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, column)| column.len())
    }

    /// The columns with their names.
    pub fn columns(&self) -> &[(String, Column)] {
        &self.columns
    }

    /// The values of a column of real numbers; `None` if there is no such column.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find_map(|(own, column)| match column {
            Column::Reals(values) if own == name => Some(values.as_slice()),
            _ => None,
        })
    }

    /// Writes `FILE.csv` and `FILE.parquet`; see [`ended`].
    ///
    /// # Errors
    /// If columns differ in length, or a file cannot be written.
    pub fn save(&self, file: &Path) -> Result<()> {
        self.save_csv(&ended(file, "csv"))?;
        self.save_parquet(&ended(file, "parquet"))
    }

    /// Writes a CSV file.
    ///
    /// # Errors
    /// As [`Frame::save`].
    pub fn save_csv(&self, file: &Path) -> Result<()> {
        self.check()?;
        let context = || format!("cannot write {}", file.display());
        let mut writer = csv::Writer::from_path(file).with_context(context)?;
        writer.write_record(self.columns.iter().map(|(name, _)| name)).with_context(context)?;
        for row in 0..self.rows() {
            writer.write_record(self.columns.iter().map(|(_, column)| column.cell(row))).with_context(context)?;
        }
        writer.flush().with_context(context)
    }

    /// Writes a complete Parquet file, or none.
    ///
    /// # Errors
    /// As [`Frame::save`].
    pub fn save_parquet(&self, file: &Path) -> Result<()> {
        self.check()?;
        let context = || format!("cannot write {}", file.display());
        let fields = self.columns.iter().map(|(name, column)| Ok(Arc::new(column.field(name)?)));
        let fields = fields.collect::<Result<Vec<_>>>()?;
        let schema = Arc::new(Type::group_type_builder("rows").with_fields(fields).build()?);
        let origin = self.origin.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(concat!("slidercrank ", env!("CARGO_PKG_VERSION")).into())
            .set_key_value_metadata(Some(origin))
            .build();
        let directory = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut whole = builder().tempfile_in(directory).with_context(context)?;
        let mut writer = SerializedFileWriter::new(whole.as_file_mut(), schema, Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        for (_, column) in &self.columns {
            let mut place = group.next_column()?.context("there are more columns than in the schema")?;
            match column {
                Column::Reals(values) => place.typed::<DoubleType>().write_batch(values, None, None)?,
                Column::Integers(values) => place.typed::<Int64Type>().write_batch(values, None, None)?,
                Column::Texts(values) => {
                    let texts: Vec<ByteArray> = values.iter().map(|text| text.as_str().into()).collect();
                    place.typed::<ByteArrayType>().write_batch(&texts, None, None)?
                }
            };
            place.close()?;
        }
        group.close()?;
        writer.close()?;
        whole.persist(file).with_context(context)?;
        Ok(())
    }

    fn check(&self) -> Result<()> {
        for (name, column) in &self.columns {
            ensure!(column.len() == self.rows(), "column `{name}` has {} rows of {}", column.len(), self.rows());
        }
        Ok(())
    }
}

/// The file `BASE.ENDING`. A dot in the base is part of its name, as in that of a study `v1.2`.
pub fn ended(base: &Path, ending: &str) -> PathBuf {
    let mut name = base.as_os_str().to_owned();
    name.push(".");
    name.push(ending);
    name.into()
}

/// Makes temporary files that others may read, if they may read new files of this process.
pub fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    fn frame() -> Frame {
        let frame = Frame::default()
            .with("run", Column::Integers(vec![0, 1]))
            .reals("force", [1.5e300, -0.1])
            .with("end", Column::Texts(vec!["reached".into(), "µ, \"quoted\"".into()]));
        Frame { origin: vec![("seed".into(), "7".into())], ..frame }
    }

    #[test]
    fn what_is_written_to_parquet_is_read_back() {
        let directory = tempfile::tempdir().expect("a directory");
        let file = directory.path().join("rows.parquet");
        frame().save_parquet(&file).expect("a file");
        let reader = SerializedFileReader::new(std::fs::File::open(&file).expect("a file")).expect("Parquet");
        let metadata = reader.metadata().file_metadata();
        assert_eq!(metadata.key_value_metadata().expect("an origin")[0], KeyValue::new("seed".into(), "7".to_owned()));
        let rows: Vec<_> = reader.get_row_iter(None).expect("rows").collect::<Result<_, _>>().expect("rows");
        let row = |i: usize| (rows[i].get_long(0), rows[i].get_double(1), rows[i].get_string(2));
        let texts = ["reached".to_owned(), "µ, \"quoted\"".to_owned()];
        for (i, force) in [1.5e300, -0.1].into_iter().enumerate() {
            let (run, found, text) = row(i);
            assert_eq!((run.ok(), found.ok(), text.ok()), (Some(i as i64), Some(force), Some(&texts[i])));
        }
    }

    #[test]
    fn a_dot_in_a_name_is_no_ending() {
        let directory = tempfile::tempdir().expect("a directory");
        frame().save(&directory.path().join("v1.2")).expect("files");
        for ending in ["csv", "parquet"] {
            let file = directory.path().join(format!("v1.2.{ending}"));
            assert!(file.is_file(), "{}", file.display());
        }
    }

    /// As of a file that is simply written.
    #[cfg(unix)]
    #[test]
    fn whoever_may_read_one_file_may_read_the_other() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().expect("a directory");
        frame().save(&directory.path().join("rows")).expect("files");
        let mode = |ending: &str| {
            let file = directory.path().join(format!("rows.{ending}"));
            std::fs::metadata(file).expect("a file").permissions().mode()
        };
        assert_eq!(mode("parquet"), mode("csv"));
    }

    #[test]
    fn columns_of_different_lengths_are_refused_before_anything_is_written() {
        let directory = tempfile::tempdir().expect("a directory");
        let file = directory.path().join("rows");
        let error = frame().reals("short", [1.0]).save(&file).expect_err("a column is short");
        assert_eq!(error.to_string(), "column `short` has 1 rows of 2");
        assert_eq!(std::fs::read_dir(directory.path()).expect("a directory").count(), 0);
    }
}
